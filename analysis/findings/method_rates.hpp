#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/finding.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/mcnemar.hpp"
#include "analysis/statistics/roc.hpp"

namespace mpm {

/// How often one method is right. A loop without a verdict counts in `answered` only; method_rate_infos()
/// says what each rate counts.
struct MethodRates {
  std::string
      reason;  ///< why there was no verdict on the first loop without one; empty when it always gave one
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

/// The rates of one method; `method` is its place in the assessments of each record.
MethodRates method_rates(const Study& study, std::size_t method, std::span<const ExperimentRecord> records);

/// Its rows, "compare.METHOD.RATE" for each rate, and "compare.METHOD.roc_area".
std::vector<Finding> rows_of(const MethodRates& rates, const MethodDescription& method);

/// Two methods on the same loops: is one right where the other is wrong? Counted are the loops that both gave
/// a verdict on.
struct MethodPair {
  FlagTruth truth;
  std::size_t first, second;  ///< places in the assessments of each record
  std::int64_t loops = 0;
  McNemarTest test;  ///< lost: right by the first alone
};

/// Every pair once for each truth, all of the first truth first.
std::vector<MethodPair> method_pairs(const Study& study, std::size_t methods,
                                     std::span<const ExperimentRecord> records);

}  // namespace mpm
