#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// How far a campaign is that is not finished.
struct Unfinished {
  std::int64_t done = 0, experiments = 0;  ///< experiments that are there, and of the whole campaign
};

/// What a campaign found, for people, at most 100 columns wide: what was run, whether the basis case is
/// healthy, the measured numbers with their intervals beside the reported ones, and which experiments failed
/// or got a wrong verdict. `file` is the archive, for the commands that replay these. The
/// summary of a campaign that is not finished says so first.
std::string summary_text(const Campaign& campaign, const StudyFindings& findings, const std::string& file,
                         const std::optional<Unfinished>& unfinished = {});

/// The same as JSON for programs, with all experiments instead of the first ones; docs/report.md lists the
/// keys. A number that does not exist is null.
std::string summary_json(const Campaign& campaign, const StudyFindings& findings,
                         const std::optional<Unfinished>& unfinished = {});

}  // namespace mpm
