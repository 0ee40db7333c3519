#pragma once

#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// How often each method of the campaign is right, for people.
std::string comparison_text(const Campaign& campaign, const StudyFindings& findings);

/// The same as JSON: an array `methods`, one object a method, and an array `pairs`.
std::string comparison_json(const Campaign& campaign, const StudyFindings& findings);

}  // namespace mpm
