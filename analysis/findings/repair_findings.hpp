#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/experiment/repair.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"
#include "base/enum_words.hpp"

namespace mpm {

/// Which channel was repaired.
enum class RepairTarget : std::int8_t {
  mismatched,   ///< one with a mismatch
  another,      ///< one without a mismatch, of a plant that has a mismatch elsewhere
  no_mismatch,  ///< a channel of a plant without a mismatch: with a disturbance, or no fault
};

template <>
inline constexpr auto kWords<RepairTarget> = word_list("a mismatched channel", "another channel",
                                                       "no mismatch");

/// The result of the repair of one experiment, whose loops must be comparable (RepairedLoop::compares()).
struct RepairOutcome {
  std::int64_t index;
  RepairTarget target;
  double loss_now, loss_repaired;  ///< as in RepairedLoop
};

RepairTarget target_of(const ExperimentDraw& draw, const Channel& channel);

/// The outcomes for one target together. A loop is better or worse if its loss changes by more than the
/// factor kNoticeableChange.
struct RepairFindings {
  RepairTarget target;
  Rate better, worse;
  Estimate loss_now, loss_repaired;  ///< medians
};

/// One entry for each target, in their order.
std::vector<RepairFindings> repair_findings(std::span<const RepairOutcome> outcomes, double confidence);

}  // namespace mpm
