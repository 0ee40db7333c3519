#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/methods/assessed_loop.hpp"
#include "results/archive/campaign.hpp"
#include "results/blind/blind_loops.hpp"
#include "results/blind/verdict_file.hpp"

namespace mpm {

/// The methods of a study as they assess its loops now, by this program and the command line `command`.
std::vector<CampaignMethod> methods_of(const Study& study, const std::string& command);

struct ComparisonOptions {
  std::vector<std::string> methods;         ///< names of assessment_methods(), each once
  std::optional<std::int64_t> experiments;  ///< the first N only
  int jobs = 1;                             ///< threads
  std::function<void()> on_done;            ///< after each loop; one call at a time, but from any thread
};

/// How many loops a comparison of this campaign has: its experiments with status ok.
std::int64_t compared_loops(const Campaign& campaign, const std::optional<std::int64_t>& experiments);

/// True when the campaign has this method on all the loops of such a comparison.
bool has_answers(const Campaign& campaign, const std::string& method,
                 const std::optional<std::int64_t>& experiments);

/// Has methods assess the experiments with status ok, in threads; the same answer for any number of
/// them, but for the processor times. They stand behind the other methods that the campaign has; answers that
/// it has of one of them, such as on its first experiments only, are replaced. A loop that was not stored is
/// run again by the solver of the campaign, where that is Ipopt one at a time: its linear solver does not
/// bear two threads.
/// @throws InputError for an unknown method, or options that do not fit the study: that of its first loop
void add_methods(Campaign& campaign, const ComparisonOptions& options, const std::string& command);

/// These loops as methods see them; run again where they were not kept. Without samples: a calibration loop
/// that does not run to its end.
std::vector<AssessedLoop> loops_of(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
                                   const std::function<void()>& on_done);

/// Puts verdicts from outside behind the answers of the methods that the campaign has, in the place of those
/// of the same name.
void add_verdicts(Campaign& campaign, const OutsideVerdicts& verdicts, const std::string& command);

/// The campaign with these of its methods alone, in this order, on its first `experiments`.
Campaign with_methods(Campaign campaign, const std::vector<std::string>& methods,
                      const std::optional<std::int64_t>& experiments);

}  // namespace mpm
