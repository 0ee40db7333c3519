#include "analysis/findings/method_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/experiment/repair.hpp"
#include "analysis/findings/monitored_loop.hpp"
#include "analysis/findings/world_counts.hpp"
#include "analysis/methods/source_probabilities.hpp"
#include "analysis/statistics/least_effect.hpp"
#include "base/non_finite.hpp"

namespace mpm {

struct LoopMeasures {
  WorldMean repair_gain_share, repair_gain_share_05;
  std::int64_t false_alarms = 0, verdicts_before = 0;
  std::vector<double> delays;
  /// Scores of the loops with a fault that has an impact, with a fault that has none, and of the healthy
  /// loops.
  std::vector<double> impact_scores, no_impact_scores, healthy_scores;
  std::vector<double> milliseconds, channels_named, size_errors;
  std::vector<EffectTrial> effects;  ///< of the faults, and whether the score is above the threshold for 5 %
  WorldMean log_score, brier_score;
  Reliability reliability;
};

namespace {

/// A loop that a method has looked at, and what can be said about its answer.
struct SeenLoop {
  const Study& study;
  const ExperimentRecord& record;
  const AssessmentRecord& said;
  const CalibratedThresholds& thresholds;
  FaultTruth truth = truth_of(study, record);
  Judgement judgement = said.answered() && truth.faulty() ? judge(study, record, said) : Judgement{};
  /// Set in a study that monitors, if the loop has a verdict and no bad tuning.
  std::optional<MonitoredLoop> windows = {};

  SeenLoop(const Study& of_study, const ExperimentRecord& of_record, const AssessmentRecord& of_method,
           const CalibratedThresholds& at)
      : study(of_study), record(of_record), said(of_method), thresholds(at) {
    if (study.monitoring && said.answered() && record.draw.kind != ExperimentKind::tuning)
      windows = monitored_loop(study, record, said);
  }

  /// Time from the onset of a fault with an impact to the first flagged window; NaN without such a fault.
  double delay() const { return windows && truth.impact ? windows->delay : kNaN; }

  LoopOutcome outcome() const;
  /// Adds the values of this loop to `all`.
  void measure(LoopMeasures& all) const;

 private:
  void measure_repair(LoopMeasures& all) const;
  void measure_fault(LoopMeasures& all) const;
};

LoopOutcome SeenLoop::outcome() const {
  if (!said.answered())
    return {};
  const MethodDescription& method = said.form->method();
  const Eigen::Index cv = record.draw.true_cv();
  LoopOutcome outcome{
      .answered = true,
      .flagged = said.flagged,
      .above_05 = thresholds.at_05.exceeded_by(said.score),
      .above_chosen = thresholds.chosen.exceeded_by(said.score),
      .right_cv = truth.faulty() && said.flagged && method.locates_cvs && cv >= 0 && said.predicted_cv == cv,
      .right_source =
          truth.faulty() && method.tells_sources && names_source(truth.kind, said.predicted_source),
      .above_01 = thresholds.at_01.exceeded_by(said.score),
      .above_not_mpm = thresholds.not_mpm.exceeded_by(said.score),
      .names_source = named_source(said) != FaultSource::none,
      .channel = judgement.channel,
      .parameter = judgement.parameter,
      .size = judgement.size,
      .candidate = judgement.candidate,
      .redrawn_05 = static_cast<std::uint8_t>(thresholds.redraws_exceeded_by(said.score)),
      .told = method.tells_sources ? said.told() : ToldSource::none};
  if (method.tells_sources && (truth.has_mismatch() || truth.kind == ExperimentKind::ud)) {
    const FaultSource named = said.predicted_source;
    const bool says_so = named == FaultSource::mpm || named == FaultSource::mpm_ud;
    outcome.mismatch = says_so == truth.has_mismatch() ? Correctness::right : Correctness::wrong;
  }
  if (!std::isnan(delay()))
    outcome.window = std::isfinite(delay()) ? Correctness::right : Correctness::wrong;
  return outcome;
}

void SeenLoop::measure(LoopMeasures& all) const {
  if (study.world)
    measure_repair(all);
  if (!said.answered())
    return;
  if (!std::isnan(said.milliseconds))  // NaN would break the order for the median
    all.milliseconds.push_back(said.milliseconds);
  if (windows) {
    all.false_alarms += windows->false_alarms;
    all.verdicts_before += windows->verdicts_before;
  }
  if (!std::isnan(delay()))
    all.delays.push_back(delay());
  if (const std::optional<SourceProbabilities> stated = stated_probabilities(said)) {
    const FaultSource source = source_of(truth.kind);
    all.log_score.add(record.draw.world, log_score(*stated, source));
    all.brier_score.add(record.draw.world, brier_score(*stated, source));
    all.reliability.add(*stated, source);
  }
  if (truth.faulty())
    measure_fault(all);
  else if (truth.kind == ExperimentKind::healthy)
    all.healthy_scores.push_back(said.score);
}

/// Adds the share of the best repair's gain that a repair of the named channel brings.
void SeenLoop::measure_repair(LoopMeasures& all) const {
  const MethodDescription& method = said.form->method();
  if (!(method.names_channels || method.names_mismatches) || !truth.impact || !record.repair.best())
    return;
  const int world = record.draw.world;
  const bool is_above = said.answered() && thresholds.at_05.exceeded_by(said.score);
  all.repair_gain_share.add(world, record.repair.share_of(channel_to_repair(said)));
  if (thresholds.at_05.value)
    all.repair_gain_share_05.add(world,
                                 record.repair.share_of(is_above ? named_channel(said) : std::nullopt));
}

void SeenLoop::measure_fault(LoopMeasures& all) const {
  if (study.world && thresholds.at_05.value && record.cost && !record.cost->variance_ratio.hasNaN())
    all.effects.push_back({(record.cost->variance_ratio.array() - 1.0).abs().maxCoeff(),
                           thresholds.at_05.exceeded_by(said.score), record.draw.world});
  (truth.impact ? all.impact_scores : all.no_impact_scores).push_back(said.score);
  if (said.flagged && judgement.channel != Correctness::not_judged)
    all.channels_named.push_back(said.values("channel_flagged").sum());
  if (said.flagged && !std::isnan(judgement.size_error))
    all.size_errors.push_back(judgement.size_error);
}

/// Each window counts for the time since the window before it, which is one stride.
Estimate alarms_a_day(const Study& study, const LoopMeasures& counts) {
  const std::optional<double> days = days_in(study.plant.time_unit);
  if (!study.monitoring || !days)
    return {};
  const double stride = study.monitoring->stride * study.controller.sample_time * *days;
  Estimate alarms = poisson_rate(counts.false_alarms, static_cast<double>(counts.verdicts_before) * stride,
                                 study.aggregate.confidence);
  alarms.count = counts.verdicts_before;
  return alarms;
}

constexpr std::array<EstimateRow, 10> kEstimates{{
    {{"log_score", "Logarithmic score",
      "mean of -ln p / ln 1000, p the stated probability of what is true (no fault, a mismatch, a "
      "disturbance, "
      "both, another fault) and at least 0.001: 0 for a certain and right statement, 1 for a certain and "
      "wrong "
      "one",
      true},
     [](const LoopMeasures& of, const Study& study) {
       return of.log_score.mean(study.aggregate.confidence);
     }},
    {{"brier_score", "Brier score",
      "mean of half the squared distance of the stated probabilities from what is true: 0 to 1", true},
     [](const LoopMeasures& of, const Study& study) {
       return of.brier_score.mean(study.aggregate.confidence);
     }},
    {{"calibration_error", "Calibration error",
      "mean difference of the stated probability of the likeliest source and the share of loops in which it "
      "is "
      "the truth, in bins of a tenth",
      true},
     [](const LoopMeasures& of, const Study&) {
       return Estimate{.value = of.reliability.error(), .count = of.reliability.count()};
     },
     false},
    {{"channels_named", "Channels named, mean",
      "mean number of channels named, over the flagged loops with one mismatch of an MV", true},
     [](const LoopMeasures& of, const Study&) { return mean_estimate(of.channels_named); },
     false},
    {{"size_error", "Error of the size, median",
      "median of the error of the size divided by the true deviation from the model, over the flagged loops "
      "with one mismatch of an MV whose channel and parameter are named",
      true},
     [](const LoopMeasures& of, const Study& study) {
       return median_estimate(of.size_errors, study.aggregate.confidence);
     }},
    {{"repair_gain_share", "Repair gain",
      "mean share of the best repair's gain that repairing the named channel brings, over all loops with "
      "mismatches that have an impact and a repair with a gain, with or without verdict; 0 if the loop is "
      "not "
      "flagged, no channel is named, or the repair brings nothing",
      false, StudyFeature::worlds},
     [](const LoopMeasures& of, const Study& study) {
       return of.repair_gain_share.mean(study.aggregate.confidence);
     }},
    {{"repair_gain_share_05", "Repair gain at 5 %",
      "the same with the loop flagged if its score is above the threshold calibrated for 5 % false alarms",
      false, StudyFeature::calibrated_worlds},
     [](const LoopMeasures& of, const Study& study) {
       return of.repair_gain_share_05.mean(study.aggregate.confidence);
     }},
    {{"least_effect_80", "Least effect, 80 % found",
      "smallest relative change of the variance of a CV from which on 80 % of the faults are above the "
      "threshold calibrated for 5 % false alarms; infinite if even large faults are not found so often",
      true, StudyFeature::calibrated_worlds},
     [](const LoopMeasures& of, const Study& study) {
       return least_effect(of.effects, 0.8, study.aggregate.confidence, study.seed);
     }},
    {{"detection_delay", "Delay, median",
      "median time from the onset to the end of the first flagged window, in the time unit of the plant, "
      "over "
      "the loops with a fault that has an impact; infinite if no window is flagged",
      true, StudyFeature::monitoring},
     [](const LoopMeasures& of, const Study& study) {
       return median_estimate(of.delays, study.aggregate.confidence);
     }},
    {{"false_alarms_a_day", "Alarms a day",
      "number of alarms that begin in windows without a fault, divided by the time that these windows cover: "
      "before the onset, and in loops without a fault and with the designed tuning",
      true, StudyFeature::monitoring},
     [](const LoopMeasures& of, const Study& study) { return alarms_a_day(study, of); }},
}};

constexpr std::array<ThresholdRow, 4> kThresholds{{
    {{"threshold_01", "Threshold, 1 %", "score that at most 1 % of the loops without a fault exceed", false,
      StudyFeature::calibration},
     &CalibratedThresholds::at_01},
    {{"threshold_05", "Threshold, 5 %", "score that at most 5 % of the loops without a fault exceed", false,
      StudyFeature::calibration},
     &CalibratedThresholds::at_05},
    {{"threshold_calibrated", "Threshold, calibrated",
      "score that at most the share calibration.false_alarms of the loops without a fault exceeds", false,
      StudyFeature::calibration},
     &CalibratedThresholds::chosen},
    {{"threshold_05_mpm", "Threshold, not disturbance, 5 %",
      "score that at most 5 % of the loops without a fault or with a disturbance alone exceed", false,
      StudyFeature::calibration},
     &CalibratedThresholds::not_mpm},
}};

constexpr std::array<AreaRow, 2> kAreas{{
    {{"roc_area", "Area under ROC, fault", "area under the ROC curve of its score"},
     &MethodRates::roc,
     &MethodRates::roc_area},
    {{"roc_area_impact", "Area under ROC, impact",
      "area under the ROC curve of its score, faults with an impact against all other loops"},
     &MethodRates::roc_impact,
     &MethodRates::roc_impact_area},
}};

/// The interval of the area under a curve.
Interval area_of(const RocCurve& curve, double confidence) {
  return curve.defined() ? area_interval(curve.area, curve.positives, curve.negatives, confidence)
                         : Interval{kNaN, kNaN};
}

/// The loops that one method has looked at.
class MethodCounts {
 public:
  MethodCounts(const Study& study, std::size_t method, const Calibration& calibration)
      : study_(study), method_(method) {
    if (study.calibration)
      found_.thresholds = calibrated_thresholds(study, calibration, method);
  }

  void add(const ExperimentRecord& record) {
    const AssessmentRecord& said = record.assessments[method_];
    if (said.status == AssessmentStatus::not_assessed) {
      found_.outcomes.emplace_back();
      return;
    }
    const SeenLoop loop(study_, record, said, found_.thresholds);
    const LoopOutcome outcome = loop.outcome();
    found_.outcomes.emplace_back(outcome);
    counts_.add({outcome_scope(study_, said.form->method(), found_.thresholds), loop.truth, outcome},
                record.draw.world);
    loop.measure(measures_);
    found_.failures.add(said);
    if (found_.reason.empty())
      found_.reason = said.reason;
  }

  MethodRates result() {
    const double confidence = study_.aggregate.confidence;
    found_.rates = counts_.rates(confidence);
    for (const EstimateRow& row : estimate_rows())
      found_.estimates.of(row) = row.estimate(measures_, study_);
    found_.reliability = measures_.reliability;
    found_.milliseconds = median_estimate(std::move(measures_.milliseconds), confidence).value;
    const SortedScores impact(std::move(measures_.impact_scores)),
        no_impact(std::move(measures_.no_impact_scores)), healthy(std::move(measures_.healthy_scores));
    found_.roc = roc_curve({impact, no_impact}, {healthy});
    found_.roc_impact = roc_curve({impact}, {no_impact, healthy});
    for (const AreaRow& row : area_rows())
      found_.*row.interval = area_of(found_.*row.curve, confidence);
    return std::move(found_);
  }

 private:
  const Study& study_;
  std::size_t method_;
  MethodRates found_ = {};
  RateCounts counts_ = RateCounts();
  LoopMeasures measures_;
};

}  // namespace

void VerdictFailures::add(const AssessmentRecord& said) {
  const bool is_failure = said.status == AssessmentStatus::failed;
  asked += said.answered() || is_failure ? 1 : 0;
  failed += is_failure ? 1 : 0;
  if (is_failure && reason.empty())
    reason = said.reason;
}

void VerdictFailures::add(const VerdictFailures& more) {
  asked += more.asked;
  failed += more.failed;
  if (reason.empty())
    reason = more.reason;
}

std::span<const EstimateRow> estimate_rows() {
  return kEstimates;
}

std::span<const ThresholdRow> threshold_rows() {
  return kThresholds;
}

std::span<const AreaRow> area_rows() {
  return kAreas;
}

std::vector<MethodNumber> method_numbers() {
  std::vector<MethodNumber> all;
  const auto add = [&all](const auto& rows) { all.insert(all.end(), rows.begin(), rows.end()); };
  add(rate_rows());
  add(area_rows());
  add(estimate_rows());
  add(threshold_rows());
  all.push_back(kRunTime);
  return all;
}

MethodNumber method_number(std::string_view name) {
  const std::vector<MethodNumber> all = method_numbers();
  return row_of(std::span(all), name);
}

std::string heading_of(std::string_view name) {
  return method_number(name).heading;
}

Collector<MethodRates> rate_collector(const Study& study, std::size_t method,
                                      const Calibration& calibration) {
  return collector_of(MethodCounts(study, method, calibration));
}

std::vector<UnansweredPart> unanswered_parts(const Study& study, const MethodRates& rates) {
  std::vector<UnansweredPart> parts;
  if (study.calibration && rates.thresholds.not_mpm.loops == 0)
    parts.push_back(
        {"calibration", "no verdict on any calibration loop, so no rate at a calibrated threshold"});
  if (study.monitoring && rates["monitored_impact"].total == 0 &&
      rates.estimates["false_alarms_a_day"].count == 0)
    parts.push_back({"windows", "no verdict on any window, so no delay and no alarms per day"});
  return parts;
}

bool answers_and_detects(const MethodRates& rates) {
  constexpr double kDetects = 0.5;
  const Rate &answered = rates["answered"], &alarms = rates["false_alarm_healthy"];
  const Rate& detected = rates["detected_impact"].total > 0 ? rates["detected_impact"] : rates["detected"];
  const bool answers = answered.total > 0 && answered.value >= kFewestAnswers;
  const bool detects = detected.total > 0 && detected.value >= kDetects;
  return answers && detects && (alarms.total == 0 || detected.value > alarms.value);
}

Finding method_finding(const std::string& method, const std::string& name, const std::string& label,
                       const std::string& meaning) {
  return {.name = fmt::format("compare.{}.{}", method, name),
          .label = label,
          .meaning = fmt::format("{}: {}", method, meaning),
          .group = FindingGroup::method,
          .method = method};
}

Finding method_finding(const std::string& method, const MethodNumber& number, const std::string& prefix) {
  return method_finding(method, prefix + number.name, number.heading, number.meaning);
}

std::vector<Finding> rows_of(const Study& study, const MethodRates& rates, const MethodDescription& method) {
  std::vector<Finding> rows;
  for (const RateRow& row : rows_for(study, rate_rows()))
    rows.push_back(method_finding(method.name, row).with(rates.rates.of(row)));
  for (const AreaRow& row : area_rows()) {
    const RocCurve& curve = rates.*row.curve;
    rows.push_back(method_finding(method.name, row)
                       .with(curve.area, rates.*row.interval, curve.positives + curve.negatives));
  }
  for (const EstimateRow& row : rows_for(study, estimate_rows())) {
    const Estimate& found = rates.estimates.of(row);
    Finding finding = method_finding(method.name, row);
    finding.has_interval = row.has_interval;
    rows.push_back(finding.with(found.value, found.interval, found.count));
  }
  for (const ThresholdRow& row : rows_for(study, threshold_rows())) {
    const CalibratedThreshold& threshold = rates.thresholds.*row.threshold;
    Finding finding = method_finding(method.name, row);
    finding.has_interval = false;
    rows.push_back(finding.with(threshold.value.value_or(kNaN), {kNaN, kNaN}, threshold.loops));
  }
  return rows;
}

FalseAlarmMark false_alarm_mark(const MethodDescription& method, const MethodRates& rates) {
  const double stated = method.stated_false_alarms.value_or(kUsualFalseAlarms);
  const Rate& found = rates["false_alarm_healthy"];
  if (found.total == 0 || found.interval.contains(stated))
    return FalseAlarmMark::none;
  return found.interval.lower > stated ? FalseAlarmMark::more : FalseAlarmMark::fewer;
}

}  // namespace mpm
