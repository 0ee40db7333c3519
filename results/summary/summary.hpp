#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// Progress of an unfinished run.
struct Unfinished {
  std::int64_t done = 0, experiments = 0;  ///< experiments finished, and in the whole campaign
};

/// Makes the summary of a run: the study, whether the basis case is healthy, the measured numbers with their
/// intervals beside the reported ones, which experiments failed or got a wrong verdict, and, if there are
/// several methods, the methods side by side. `file` is the archive, for the commands that replay
/// experiments. The summary of an unfinished campaign begins with that fact. As a text it is at most 100
/// columns wide, except for the methods. Its data list all experiments instead of the first ones;
/// docs/report.md lists the keys. `campaign` and `findings` must outlive it.
Document summary_document(const Campaign& campaign, const StudyFindings& findings, const std::string& file,
                          const std::optional<Unfinished>& unfinished = {});

}  // namespace mpm
