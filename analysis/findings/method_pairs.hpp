#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/collector.hpp"
#include "analysis/statistics/mcnemar.hpp"

namespace mpm {

/// Two methods on the same loops: is one right where the other is wrong? Counted are the loops on which both
/// gave a verdict. In worlds the test is clustered_mcnemar(), worlds being the clusters.
struct MethodPair {
  FlagTruth truth;
  std::size_t first, second;  ///< places in the assessments of each record
  std::int64_t loops = 0;
  McNemarTest test;     ///< lost: right by the first alone
  double p_holm = 1.0;  ///< test.p_two_sided corrected for all pairs of this truth that have loops
};

/// Every pair once for each truth, all of the first truth first. `study` must outlive the collector.
Collector<std::vector<MethodPair>> pair_collector(const Study& study, std::size_t methods);

}  // namespace mpm
