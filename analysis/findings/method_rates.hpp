#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/calibration.hpp"
#include "analysis/findings/collector.hpp"
#include "analysis/findings/finding.hpp"
#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/mcnemar.hpp"
#include "analysis/statistics/roc.hpp"
#include "base/enum_words.hpp"

namespace mpm {

/// How often a method was asked and failed (AssessmentStatus::failed). A loop to which it does not apply asks
/// nothing of it.
struct VerdictFailures {
  std::int64_t failed = 0;
  std::int64_t asked = 0;   ///< loops with a verdict, and these
  std::string reason = {};  ///< of the first one; empty: none

  void add(const AssessmentRecord& said);
  void add(const VerdictFailures& more);
};

/// How often one method is right. A loop without a verdict counts in `answered` only; method_rate_infos()
/// says what each rate counts, and method_estimate_infos() what each estimate is.
struct MethodRates {
  std::string
      reason;  ///< why there was no verdict on the first loop without one; empty when it always gave one
  std::string outcomes =
      {};  ///< a letter_of(LoopOutcome) for each record, in their order; kNoLoop: not assessed
  VerdictFailures failures = {};
  Rate answered = {}, detected = {}, detected_mpm = {}, detected_ud = {}, detected_impact = {},
       flagged_without_impact = {}, false_alarm_healthy = {}, false_alarm_tuning = {}, located = {},
       source = {}, channel = {}, channel_impact = {}, parameter_impact = {}, size_covered = {},
       candidate = {}, source_all = {}, abstained = {};
  // At calibrated thresholds; nothing is counted without one.
  Rate false_alarm_calibrated = {}, power_01 = {}, power_05 = {}, power_05_impact = {}, power_05_mpm = {};
  Rate source_05_impact = {};  // in worlds alone
  // On moving windows; nothing is counted in a study that does not monitor.
  Rate monitored_impact = {};
  Estimate detection_delay = {}, false_alarms_a_day = {};
  CalibratedThresholds thresholds;
  RocCurve roc;       ///< of the score, loops with a fault against healthy ones
  Interval roc_area;  ///< of roc.area; NaN when there is no curve
  RocCurve
      roc_impact;  ///< loops with a fault that has an impact against those with another one and healthy ones
  Interval roc_impact_area;
  Estimate channels_named = {}, size_error = {};
  Estimate repair_gain_share = {}, repair_gain_share_05 = {};  // in worlds alone
  double milliseconds;  ///< median processor time a loop, of those answered; NaN without
};

/// Which studies have a number.
enum class StudyFeature : std::int8_t {
  any,
  candidates,
  calibration,
  monitoring,
  worlds,
  calibrated_worlds,
};

/// A rate of a method under the name that text, JSON, archive, report and gates have for it. All are shares
/// of loops.
struct MethodRateInfo {
  const char* name;     ///< "false_alarm_healthy"
  const char* title;    ///< for people: "false alarms, healthy"
  const char* meaning;  ///< which loops are looked at, and which of them count
  Rate MethodRates::*rate;
  StudyFeature of = StudyFeature::any;
};

/// Every rate of MethodRates once, in the order in which people read them.
std::span<const MethodRateInfo> method_rate_infos();
/// Those that this study can have.
std::vector<MethodRateInfo> method_rate_infos(const Study& study);

/// A number of a method that is no share of loops, under the name that text, JSON and archive have for it.
struct MethodEstimateInfo {
  const char* name;     ///< "size_error"
  const char* title;    ///< for people
  const char* meaning;  ///< which loops are looked at, and what of them is counted
  Estimate MethodRates::*estimate;
  bool has_interval = true;
  StudyFeature of = StudyFeature::any;
};

/// Every estimate of MethodRates once, in the order in which people read them.
std::span<const MethodEstimateInfo> method_estimate_infos();
/// Those that this study can have.
std::vector<MethodEstimateInfo> method_estimate_infos(const Study& study);

/// A calibrated threshold under the name that its finding and JSON have.
struct ThresholdInfo {
  const char* name;     ///< "threshold_05"
  const char* meaning;  ///< the share of which loops is above it at most
  CalibratedThreshold CalibratedThresholds::*threshold;
};

/// Every threshold of CalibratedThresholds once.
std::span<const ThresholdInfo> threshold_infos();

/// The rates of one method; `method` is its place in the assessments of each record and of each loop of
/// `calibration`, which may have none. `study` must outlive the collector.
Collector<MethodRates> rate_collector(const Study& study, std::size_t method,
                                      const Calibration& calibration = {});

/// The parts of the study on which the method gave no verdict at all, each with the rates that cannot be had
/// without: {"calibration", "no verdict on a calibration loop: no rate at a calibrated threshold"}.
struct UnansweredPart {
  const char* name;    ///< "calibration", "windows"
  const char* reason;  ///< for people
};
std::vector<UnansweredPart> unanswered_parts(const Study& study, const MethodRates& rates);

/// Of the loops: with a verdict on fewer, a method is not judged on the same loops as the others.
inline constexpr double kFewestAnswers = 0.9;

/// Can this method be called the best at something? It gives a verdict on nearly all loops (kFewestAnswers),
/// and flags at least half of the faults with an impact (of all faults, where none has one), and more of them
/// than of the healthy loops. One that flags next to nothing may be right in all that it flags.
bool answers_and_detects(const MethodRates& rates);

/// The row "compare.METHOD.NAME", without a value.
Finding method_finding(const std::string& method, const std::string& name, const std::string& label,
                       const std::string& meaning);

/// Its rows: "compare.METHOD.RATE" for each rate that the study can have, "compare.METHOD.roc_area",
/// "compare.METHOD.roc_area_impact", the estimates, and in a study with a calibration the thresholds.
std::vector<Finding> rows_of(const Study& study, const MethodRates& rates, const MethodDescription& method);

/// How the false alarms of a method agree with what it states of them.
enum class FalseAlarmMark : std::int8_t {
  none,   ///< they do, or no healthy loop has a verdict
  fewer,  ///< the interval of the rate of the healthy loops that it flags lies below
  more,   ///< it lies above
};

template <>
inline constexpr auto kWords<FalseAlarmMark> = word_list("", "fewer", "more");

/// What a rate of false alarms is held against when the method states none.
inline constexpr double kUsualFalseAlarms = 0.05;

FalseAlarmMark false_alarm_mark(const MethodDescription& method, const MethodRates& rates);

/// Two methods on the same loops: is one right where the other is wrong? Counted are the loops that both gave
/// a verdict on. In worlds the test is clustered_mcnemar(), worlds being the clusters.
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
