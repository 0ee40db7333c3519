#pragma once

#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// What a campaign found, for people, at most 100 columns wide: what was run, whether the basis case is
/// healthy, the measured numbers with their intervals beside the reported ones, and which experiments failed
/// or got a wrong verdict. `file` is the archive, for the commands that replay these.
std::string summary_text(const Campaign& campaign, const StudyFindings& findings, const std::string& file);

/// The same as JSON for programs, with all experiments instead of the first ones; docs/summary.md lists the
/// keys. A number that does not exist is null.
std::string summary_json(const Campaign& campaign, const StudyFindings& findings);

}  // namespace mpm
