#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/findings/comparison.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

struct ComparisonOptions {
  std::vector<std::string> methods;         ///< names of assessment_methods()
  std::optional<std::int64_t> experiments;  ///< the first N only
  int jobs = 1;                             ///< threads
  std::function<void()> on_done;            ///< after each loop; one call at a time, but from any thread
};

/// How many loops a comparison of this campaign has: its experiments with status ok.
std::int64_t compared_loops(const Campaign& campaign, const std::optional<std::int64_t>& experiments);

/// Assesses every experiment with status ok in OpenMP threads; the same answer for any number of them, but
/// for the processor times. A loop that was not stored is run again by the solver of the campaign, where that
/// is Ipopt one at a time: its linear solver does not bear two threads.
/// @throws InputError for an unknown method, or options that do not fit the study: that of its first loop
Comparison run_comparison(const Campaign& campaign, const ComparisonOptions& options);

}  // namespace mpm
