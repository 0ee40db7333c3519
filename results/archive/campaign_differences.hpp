#pragma once

#include <vector>

#include "analysis/study_files/study_differences.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// Lists the settings that decide the answers of two campaigns and differ between them. These are the keys of
/// their studies (study_differences()) and, for each method that both have, the keys of its method file if it
/// comes from outside, under the names that they have in that file:
///
/// | key                        | value                                                             |
/// |----------------------------|-------------------------------------------------------------------|
/// | method.NAME.options.KEY    | as JSON                                                           |
/// | method.NAME.command        | with digests of the files in it; of a file of verdicts its origin |
///
/// Errors: as resolved_study().
std::vector<StudyDifference> campaign_differences(const Campaign& before, const Campaign& now);

/// The methods of `campaign` that are not in `other`.
std::vector<std::string> methods_alone(const Campaign& campaign, const Campaign& other);

}  // namespace mpm
