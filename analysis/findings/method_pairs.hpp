#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/collector.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// Compares two methods on the same loops: how often one is right where the other is wrong. Only loops on
/// which both gave a verdict count. In worlds the test is clustered_mcnemar(), with the worlds as clusters.
struct MethodPair {
  FlagTruth truth;
  std::size_t first, second;  ///< places in the assessments of each record
  std::int64_t loops = 0;
  McNemarTest test;     ///< lost: only the first is right
  double p_holm = 1.0;  ///< test.p_two_sided corrected for all pairs of this truth that have loops
};

/// Collects every pair once for each truth, all pairs of the first truth first. `study` must outlive the
/// collector.
Collector<std::vector<MethodPair>> pair_collector(const Study& study, std::size_t methods);

}  // namespace mpm
