#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/calibration.hpp"
#include "analysis/findings/collector.hpp"
#include "analysis/findings/finding.hpp"
#include "analysis/findings/rate_table.hpp"
#include "analysis/methods/source_probabilities.hpp"
#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/roc.hpp"
#include "base/enum_words.hpp"

namespace mpm {

/// How often a method was asked for a verdict and failed (AssessmentStatus::failed). A method is not asked on
/// a loop to which it does not apply.
struct VerdictFailures {
  std::int64_t failed = 0;
  std::int64_t asked = 0;   ///< loops with a verdict, and the failed ones
  std::string reason = {};  ///< of the first failure; empty: no failure

  void add(const AssessmentRecord& said);
  void add(const VerdictFailures& more);
};

/// The measured values of the loops that a method has assessed, from which its estimates are computed.
struct LoopMeasures;

/// A number of a method that is not a share of loops.
struct EstimateRow : MethodNumber {
  Estimate (*estimate)(const LoopMeasures&, const Study&);
  bool has_interval = true;
};

/// Every estimate once, in the order in which people read them.
std::span<const EstimateRow> estimate_rows();

struct Estimates : RowValues<EstimateRow, Estimate> {
  Estimates() : RowValues(estimate_rows()) {}
};

/// How often one method is right. A loop without a verdict counts only if the meaning of a rate says so.
struct MethodRates {
  std::string reason;          ///< why the first loop without a verdict has none; empty: all have one
  LoopOutcomes outcomes = {};  ///< of the records, in their order
  VerdictFailures failures = {};
  Rates rates = Rates();
  Estimates estimates = {};
  Reliability reliability = {};  ///< of the probabilities that it states, if it states any
  CalibratedThresholds thresholds = {};
  RocCurve roc = {};       ///< of the score: loops with a fault against healthy loops
  Interval roc_area = {};  ///< of roc.area; NaN when there is no curve
  /// Of the score: loops with a fault that has an impact against all other loops, except badly tuned ones.
  RocCurve roc_impact = {};
  Interval roc_impact_area = {};
  double milliseconds = kNaN;  ///< median processor time per loop with a verdict; NaN: no such loop

  Rate& operator[](std::string_view rate) { return rates[rate]; }
  const Rate& operator[](std::string_view rate) const { return rates[rate]; }
};

/// A calibrated threshold. Its meaning says at most which share of which loops is above it.
struct ThresholdRow : MethodNumber {
  CalibratedThreshold CalibratedThresholds::*threshold;
};
std::span<const ThresholdRow> threshold_rows();

/// The area under the ROC curve of the scores against one truth.
struct AreaRow : MethodNumber {
  RocCurve MethodRates::*curve;
  Interval MethodRates::*interval;
};
std::span<const AreaRow> area_rows();

inline constexpr MethodNumber kRunTime{"milliseconds", "ms a loop",
                                       "median processor time of its verdict on a loop, in ms", true};

/// Every number of a method once.
std::vector<MethodNumber> method_numbers();
/// The number of this name; throws std::out_of_range if there is none.
MethodNumber method_number(std::string_view name);
/// The heading of the number of this name.
std::string heading_of(std::string_view name);

/// Collects the rates of one method. `method` is its place in the assessments of each record and in the
/// scores of each loop of `calibration`, which may have no loops. `study` must outlive the collector.
Collector<MethodRates> rate_collector(const Study& study, std::size_t method,
                                      const Calibration& calibration = {});

/// A part of the study on which the method gave no verdict at all, and the numbers that are missing as a
/// result: {"calibration", "no verdict on any calibration loop, so no rate at a calibrated threshold"}.
struct UnansweredPart {
  const char* name;    ///< "calibration", "windows"
  const char* reason;  ///< for people
};
std::vector<UnansweredPart> unanswered_parts(const Study& study, const MethodRates& rates);

/// The least share of loops with a verdict: with a smaller one, a method is not judged on the same loops as
/// the others.
inline constexpr double kFewestAnswers = 0.9;

/// Whether this method may be called the best at something: it gives a verdict on nearly all loops
/// (kFewestAnswers), and flags at least half of the faults with an impact (of all faults if none has an
/// impact), and more of these than of the healthy loops. A method that flags hardly any loop may be right in
/// every loop that it flags.
bool answers_and_detects(const MethodRates& rates);

/// The row "compare.METHOD.NAME", without a value.
Finding method_finding(const std::string& method, const std::string& name, const std::string& label,
                       const std::string& meaning);

/// The row "compare.METHOD.NAME" of this number, without a value; `prefix` stands before the name.
Finding method_finding(const std::string& method, const MethodNumber& number, const std::string& prefix = "");

/// Returns the rows of a method: the rates that the study can have, the areas, the estimates that the study
/// can have and, in a study with a calibration, the thresholds.
std::vector<Finding> rows_of(const Study& study, const MethodRates& rates, const MethodDescription& method);

/// How the false alarms of a method agree with the rate that it states.
enum class FalseAlarmMark : std::int8_t {
  none,   ///< they agree, or no healthy loop has a verdict
  fewer,  ///< the interval of its share of flagged healthy loops lies below the stated rate
  more,   ///< the interval lies above the stated rate
};

template <>
inline constexpr auto kWords<FalseAlarmMark> = word_list("", "fewer", "more");

/// The rate with which a rate of false alarms is compared when the method states none.
inline constexpr double kUsualFalseAlarms = 0.05;

FalseAlarmMark false_alarm_mark(const MethodDescription& method, const MethodRates& rates);

}  // namespace mpm
