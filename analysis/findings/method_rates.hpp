#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/comparison.hpp"
#include "analysis/findings/study_aggregate.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/mcnemar.hpp"
#include "analysis/statistics/roc.hpp"

namespace mpm {

/// How often one method is right. A loop without a verdict counts in `answered` only; method_rate_infos()
/// says what each rate counts.
///
/// A fault is of kind mpm, ud or mpm_ud. It has an impact when Ivar_basis (6.22), the variance of some CV
/// against the same loop without fault, lies outside the band of impact of the study: a truth that no method
/// under test has a part in.
struct MethodRates {
  std::string method;
  std::string reason;  ///< why there was no verdict, where there was none
  Rate answered, detected, detected_mpm, detected_ud, detected_impact, flagged_without_impact,
      false_alarm_healthy, false_alarm_tuning, located, source, channel;
  RocCurve roc;         ///< of the score, loops with a fault against healthy ones
  Interval roc_area;    ///< of roc.area; NaN when there is no curve
  double milliseconds;  ///< median processor time a loop, of those answered; NaN without
};

/// A rate of a method under the name that text, JSON, archive, report and gates have for it. All are shares
/// of loops.
struct MethodRateInfo {
  const char* name;     ///< "false_alarm_healthy"
  const char* title;    ///< for people: "false alarms, healthy"
  const char* meaning;  ///< which loops are looked at, and which of them count
  Rate MethodRates::*rate;
};

/// Every rate of MethodRates once, in the order in which people read them.
std::span<const MethodRateInfo> method_rate_infos();

/// Which loops a method is right to flag, and no others.
enum class FlagTruth : std::int8_t {
  fault = 0,  ///< those with a fault: what a monitor of the model should see
  impact =
      1,  ///< those with a fault that has an impact: what a monitor of the control performance should see
};

/// "fault", "impact"
std::string_view to_string(FlagTruth truth);

/// Two methods on the same loops: is one right where the other is wrong? Counted are the loops that both gave
/// a verdict on.
struct MethodPair {
  FlagTruth truth;
  std::size_t first, second;  ///< places in Comparison::methods
  std::int64_t loops = 0;
  McNemarTest test;  ///< lost: right by the first alone
};

struct ComparisonSummary {
  std::vector<MethodRates> methods;
  std::vector<MethodPair> pairs;  ///< every pair once for each truth, all of the first truth first
};

/// The rates of every method, from its verdicts and the truth in `records`, which have every experiment of
/// the comparison. Throws InputError when they have not.
ComparisonSummary summarise(const Comparison& comparison, std::span<const ExperimentRecord> records,
                            const Study& study);

/// The numbers of every method that a gate can be put on: "compare.METHOD.RATE" for each rate, and
/// "compare.METHOD.roc_area".
std::vector<AggregateValue> named_values(const ComparisonSummary& summary);

}  // namespace mpm
