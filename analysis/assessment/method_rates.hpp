#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/assessment/comparison.hpp"
#include "analysis/interval.hpp"
#include "analysis/mcnemar.hpp"
#include "analysis/roc.hpp"

namespace mpm {

/// How often one method is right. Loops to which it does not apply are not counted, but in `answered`.
///
/// | member              | of the loops                        | share |
/// |---------------------|-------------------------------------|----------------------------------------------|
/// | answered            | all                                 | the method gave a verdict | | detected |
/// with a fault (mpm, ud, mpm_ud)      | flagged                                      | | detected_impact |
/// with a fault that has an impact     | flagged                                      | | false_alarm_healthy
/// | without fault, design tuning        | flagged                                      | |
/// false_alarm_tuning  | without fault, bad tuning           | flagged                                      |
/// | located             | flagged, one CV affected            | that CV has the largest score | | source |
/// flagged, mpm or ud                  | the source of the located CV is right        | | channel | flagged,
/// one mismatch of an MV      | its channel is among the flagged ones        |
///
/// A fault has an impact when Ivar_basis (6.22), the variance of some CV against the same loop without fault,
/// lies outside the band of impact of the study: a truth that no method under test has a part in.
struct MethodRates {
  std::string method;
  std::string reason;  ///< why there was no verdict, where there was none
  Rate answered, detected, detected_impact, false_alarm_healthy, false_alarm_tuning, located, source, channel;
  RocCurve roc;         ///< of the score, loops with a fault against healthy ones
  Interval roc_area;    ///< of roc.area; NaN when there is no curve
  double milliseconds;  ///< median processor time a loop, of those answered; NaN without
};

/// Two methods on the same loops: is one right where the other is wrong? Right is a flagged loop with a fault
/// and a loop without one that is not flagged; counted are the loops that both gave a verdict on.
struct MethodPair {
  std::size_t first, second;  ///< places in Comparison::methods
  std::int64_t loops = 0;
  McNemarTest test;  ///< lost: right by the first alone
};

struct ComparisonSummary {
  std::vector<MethodRates> methods;
  std::vector<MethodPair> pairs;  ///< every pair once
};

/// The rates of every method, from its verdicts and the truth in `records`, which have every experiment of
/// the comparison. Throws InputError when they have not.
ComparisonSummary summarise(const Comparison& comparison, std::span<const ExperimentRecord> records,
                            const Study& study);

}  // namespace mpm
