#include "analysis/findings/method_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/experiment/repair.hpp"
#include "analysis/findings/loop_outcome.hpp"
#include "analysis/findings/monitored_loop.hpp"
#include "analysis/findings/world_counts.hpp"
#include "analysis/statistics/holm.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kNone = kNaN;

/// Counts trials and hits in each world.
class Count : public WorldCount {
 public:
  using WorldCount::add;
  void add(int world, Correctness correctness) {
    if (correctness != Correctness::not_judged)
      add(world, correctness == Correctness::right);
  }
};

/// What OutcomeCounts does not count.
struct Counts {
  Count channel, channel_impact, parameter_impact, size_covered, candidate, abstained;
  Count power_01, power_05_mpm;
  Count monitored_impact;
  WorldMean repair_gain_share, repair_gain_share_05;
  int world = 0;  ///< of the record at hand
  std::int64_t false_alarms = 0, verdicts_before = 0;
  std::vector<double> delays;
  /// Of the loops with a fault that has an impact, or none, and of the healthy ones.
  std::vector<double> impact_scores, no_impact_scores, healthy_scores;
  std::vector<double> milliseconds, channels_named, size_errors;
  CalibratedThresholds thresholds;

  void add(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
    world = record.draw.world;
    if (study.world)
      add_repair(study, record, said);
    if (!is_faultless(record.draw.kind) && said.form->method().tells_sources)
      abstained.add(world, named_source(said) == FaultSource::none);
    if (!said.answered())
      return;
    if (!std::isnan(said.milliseconds))  // it would break the order for the median
      milliseconds.push_back(said.milliseconds);
    if (study.monitoring)
      add_windows(study, record, said);
    if (!is_faultless(record.draw.kind))
      add_fault(study, record, said);
    else if (record.draw.kind == ExperimentKind::healthy)
      healthy_scores.push_back(said.score);
  }

 private:
  /// Above a calibrated threshold? Not counted when there is none.
  void add_above(const CalibratedThreshold& threshold, double score, Count& count) const {
    if (threshold.value)
      count.add(world, threshold.exceeded_by(score));
  }

  /// How much of the best repair's gain the channel that it names brings.
  void add_repair(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
    const MethodDescription& method = said.form->method();
    if (!(method.names_channels || method.names_mismatches) || !has_impact(study.diagnosis, record) ||
        !record.repair.best())
      return;
    repair_gain_share.add(world, record.repair.share_of(channel_to_repair(said)));
    if (thresholds.at_05.value)
      repair_gain_share_05.add(
          world,
          record.repair.share_of(is_above(thresholds.at_05, said) ? named_channel(said) : std::nullopt));
  }

  static bool is_above(const CalibratedThreshold& threshold, const AssessmentRecord& said) {
    return said.answered() && threshold.exceeded_by(said.score);
  }

  void add_windows(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
    if (record.draw.kind == ExperimentKind::tuning)
      return;
    const MonitoredLoop found = monitored_loop(study, record, said);
    false_alarms += found.false_alarms;
    verdicts_before += found.verdicts_before;
    if (std::isnan(found.delay) || !has_impact(study.diagnosis, record))
      return;
    monitored_impact.add(world, std::isfinite(found.delay));
    delays.push_back(found.delay);
  }

  void add_fault(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
    const bool impact = has_impact(study.diagnosis, record);
    (impact ? impact_scores : no_impact_scores).push_back(said.score);
    add_above(thresholds.at_01, said.score, power_01);
    if (record.draw.kind == ExperimentKind::mpm)
      add_above(thresholds.not_mpm, said.score, power_05_mpm);
    const Judgement judgement = judge(study, record, said);
    if (said.flagged)
      add_diagnosis(judgement, said);
    if (impact) {
      channel_impact.add(world, judgement.channel);
      parameter_impact.add(world, judgement.parameter);
    }
  }

  void add_diagnosis(const Judgement& judgement, const AssessmentRecord& said) {
    channel.add(world, judgement.channel);
    if (judgement.channel != Correctness::not_judged)
      channels_named.push_back(said.values("channel_flagged").sum());
    size_covered.add(world, judgement.size);
    candidate.add(world, judgement.candidate);
    if (!std::isnan(judgement.size_error))
      size_errors.push_back(judgement.size_error);
  }
};

constexpr std::array<MethodRateInfo, 24> kRates{{
    {"answered", "answered", "share of all loops on which the method gave a verdict", &MethodRates::answered},
    {"detected", "detected", "share of the loops with a fault that are flagged", &MethodRates::detected},
    {"detected_mpm", "detected, mismatch", "share of the loops with a mismatch alone that are flagged",
     &MethodRates::detected_mpm},
    {"detected_ud", "detected, disturbance", "share of the loops with a disturbance alone that are flagged",
     &MethodRates::detected_ud},
    {"detected_impact", "detected, with impact",
     "share of the loops with a fault that has an impact that are flagged", &MethodRates::detected_impact},
    {"flagged_without_impact", "flagged, no impact",
     "share of the loops with a fault that has no impact that are flagged",
     &MethodRates::flagged_without_impact},
    {"false_alarm_healthy", "false alarms, healthy",
     "share of the loops without a fault and with the designed tuning that are flagged",
     &MethodRates::false_alarm_healthy},
    {"false_alarm_tuning", "false alarms, bad tuning",
     "share of the loops without a fault and with bad tuning that are flagged",
     &MethodRates::false_alarm_tuning},
    {"located", "CV located",
     "share of the flagged loops with a fault on one CV in which this CV has the largest score",
     &MethodRates::located},
    {"source", "source right",
     "share of the flagged loops with a mismatch or a disturbance alone in which the located CV has the "
     "right source",
     &MethodRates::source},
    {"channel", "channel named",
     "share of the flagged loops with one mismatch of an MV in which its channel is named",
     &MethodRates::channel},
    {"channel_impact", "channel, with impact",
     "share of the loops with one mismatch of an MV that has an impact in which the loop is flagged and the "
     "channel is named",
     &MethodRates::channel_impact},
    {"parameter_impact", "parameter, with impact",
     "share of the loops with one mismatch of an MV that has an impact in which the loop is flagged and the "
     "method is surest of the right channel and parameter",
     &MethodRates::parameter_impact},
    {"size_covered", "size in interval",
     "share of the flagged loops with one mismatch of an MV whose channel and parameter are named in which "
     "the interval of the size holds the true size",
     &MethodRates::size_covered},
    {"candidate", "cause named",
     "share of the flagged loops with a disturbance that a logged signal drives in which the method names "
     "this signal",
     &MethodRates::candidate, StudyFeature::candidates},
    {"source_all", "fault told, three ways",
     "share of all loops with a fault, with or without verdict, that are flagged with the right source: "
     "mismatch, disturbance or both; for another fault, `other` or none",
     &MethodRates::source_all},
    {"abstained", "no source named",
     "share of all loops with a fault, with or without verdict, in which no source is named",
     &MethodRates::abstained},
    {"false_alarm_calibrated", "calibrated: false alarms",
     "share of the loops without a fault and with the designed tuning above the threshold calibrated for the "
     "study's rate of false alarms, calibration.false_alarms",
     &MethodRates::false_alarm_calibrated, StudyFeature::calibration},
    {"power_01", "at 1 %: detected",
     "share of the loops with a fault above the threshold calibrated for 1 % false alarms",
     &MethodRates::power_01, StudyFeature::calibration},
    {"power_05", "at 5 %: detected",
     "share of the loops with a fault above the threshold calibrated for 5 % false alarms",
     &MethodRates::power_05, StudyFeature::calibration},
    {"power_05_impact", "at 5 %: with impact",
     "share of the loops with a fault that has an impact above the threshold calibrated for 5 % false alarms",
     &MethodRates::power_05_impact, StudyFeature::calibration},
    {"power_05_mpm", "at 5 %: mpm, not ud",
     "share of the loops with a mismatch alone above the threshold calibrated for 5 % false alarms among "
     "loops without a fault or with a disturbance alone",
     &MethodRates::power_05_mpm, StudyFeature::calibration},
    {"source_05_impact", "at 5 %: fault with impact told",
     "share of all loops with a fault that has an impact, with or without verdict, above the threshold "
     "calibrated for 5 % false alarms and with the right source, as for source_all",
     &MethodRates::source_05_impact, StudyFeature::calibrated_worlds},
    {"monitored_impact", "windows: with impact",
     "share of the loops with a fault that has an impact in which a window that ends after the onset is "
     "flagged",
     &MethodRates::monitored_impact, StudyFeature::monitoring},
}};

constexpr std::array<MethodEstimateInfo, 6> kEstimates{{
    {"channels_named", "channels named, mean",
     "mean number of channels named, over the flagged loops with one mismatch of an MV",
     &MethodRates::channels_named, false},
    {"size_error", "error of the size, median",
     "median of the error of the size divided by the true deviation from the model, over the flagged loops "
     "with one mismatch of an MV whose channel and parameter are named",
     &MethodRates::size_error},
    {"repair_gain_share", "share of the repair's gain, mean",
     "mean share of the best repair's gain that repairing the named channel brings, over all loops with "
     "mismatches that have an impact and a repair with a gain, with or without verdict; 0 if the loop is not "
     "flagged, no channel is named, or the repair brings nothing",
     &MethodRates::repair_gain_share, true, StudyFeature::worlds},
    {"repair_gain_share_05", "at 5 %: share of the repair's gain",
     "the same with the loop flagged if its score is above the threshold calibrated for 5 % false alarms",
     &MethodRates::repair_gain_share_05, true, StudyFeature::calibrated_worlds},
    {"detection_delay", "windows: delay, median",
     "median time from the onset to the end of the first flagged window, in the time unit of the plant, over "
     "the loops with a fault that has an impact; infinite if no window is flagged",
     &MethodRates::detection_delay, true, StudyFeature::monitoring},
    {"false_alarms_a_day", "windows: alarms a day",
     "number of alarms that begin in windows without a fault, divided by the time that these windows watch: "
     "before the onset, and in loops without a fault and with the designed tuning",
     &MethodRates::false_alarms_a_day, true, StudyFeature::monitoring},
}};

constexpr std::array<ThresholdInfo, 4> kThresholds{{
    {"threshold_01", "score that at most 1 % of the loops without a fault exceed",
     &CalibratedThresholds::at_01},
    {"threshold_05", "score that at most 5 % of the loops without a fault exceed",
     &CalibratedThresholds::at_05},
    {"threshold_calibrated",
     "score that at most the share calibration.false_alarms of the loops without a fault exceeds",
     &CalibratedThresholds::chosen},
    {"threshold_05_mpm",
     "score that at most 5 % of the loops without a fault or with a disturbance alone exceed",
     &CalibratedThresholds::not_mpm},
}};

bool has(const Study& study, StudyFeature feature) {
  switch (feature) {
    case StudyFeature::any:
      return true;
    case StudyFeature::candidates:
      return study.record.candidates > 0;
    case StudyFeature::calibration:
      return study.calibration.has_value();
    case StudyFeature::monitoring:
      return study.monitoring.has_value();
    case StudyFeature::worlds:
      return study.world.has_value();
    case StudyFeature::calibrated_worlds:
      return study.world && study.calibration;
  }
  return false;
}

/// The interval of the area under a curve.
Interval area_of(const RocCurve& curve, double confidence) {
  return curve.defined() ? area_interval(curve.area, curve.positives, curve.negatives, confidence)
                         : Interval{kNone, kNone};
}

/// A window watches the time from the one before it.
Estimate alarms_a_day(const Study& study, const Counts& counts) {
  const std::optional<double> days = days_in(study.plant.time_unit);
  if (!study.monitoring || !days)
    return {};
  const double stride = study.monitoring->stride * study.controller.sample_time * *days;
  Estimate alarms = poisson_rate(counts.false_alarms, static_cast<double>(counts.verdicts_before) * stride,
                                 study.aggregate.confidence);
  alarms.count = counts.verdicts_before;
  return alarms;
}

/// The loops that one method has looked at.
class RateCounts {
 public:
  RateCounts(const Study& study, std::size_t method, const Calibration& calibration)
      : study_(study), method_(method) {
    if (study.calibration)
      counts_.thresholds = calibrated_thresholds(study, calibration, method);
  }

  void add(const ExperimentRecord& record) {
    const AssessmentRecord& said = record.assessments[method_];
    if (said.status == AssessmentStatus::not_assessed) {
      outcomes_ += kNoLoop;
      return;
    }
    const LoopOutcome outcome = outcome_of(record, said, counts_.thresholds);
    outcomes_ += letter_of(outcome);
    outcome_counts_.add(outcome_scope(study_, said.form->method(), counts_.thresholds), record.draw.world,
                        truth_of(study_, record), outcome);
    counts_.add(study_, record, said);
    failures_.add(said);
    if (reason_.empty())
      reason_ = said.reason;
  }

  MethodRates result() {
    const double confidence = study_.aggregate.confidence;
    MethodRates rates{.reason = reason_,
                      .outcomes = std::move(outcomes_),
                      .failures = failures_,
                      .channel = counts_.channel.rate(confidence),
                      .channel_impact = counts_.channel_impact.rate(confidence),
                      .parameter_impact = counts_.parameter_impact.rate(confidence),
                      .size_covered = counts_.size_covered.rate(confidence),
                      .candidate = counts_.candidate.rate(confidence),
                      .abstained = counts_.abstained.rate(confidence),
                      .power_01 = counts_.power_01.rate(confidence),
                      .power_05_mpm = counts_.power_05_mpm.rate(confidence),
                      .monitored_impact = counts_.monitored_impact.rate(confidence),
                      .detection_delay = median_estimate(std::move(counts_.delays), confidence),
                      .false_alarms_a_day = alarms_a_day(study_, counts_),
                      .thresholds = counts_.thresholds,
                      .roc = {},
                      .roc_area = {},
                      .roc_impact = {},
                      .roc_impact_area = {},
                      .channels_named = mean_estimate(counts_.channels_named),
                      .size_error = median_estimate(std::move(counts_.size_errors), confidence),
                      .repair_gain_share = counts_.repair_gain_share.mean(confidence),
                      .repair_gain_share_05 = counts_.repair_gain_share_05.mean(confidence),
                      .milliseconds = median_estimate(std::move(counts_.milliseconds), confidence).value};
    outcome_counts_.put(rates, confidence);
    const SortedScores impact(std::move(counts_.impact_scores)),
        no_impact(std::move(counts_.no_impact_scores)), healthy(std::move(counts_.healthy_scores));
    rates.roc = roc_curve({impact, no_impact}, {healthy});
    rates.roc_impact = roc_curve({impact}, {no_impact, healthy});
    rates.roc_area = area_of(rates.roc, confidence);
    rates.roc_impact_area = area_of(rates.roc_impact, confidence);
    return rates;
  }

 private:
  const Study& study_;
  std::size_t method_;
  Counts counts_;
  OutcomeCounts outcome_counts_;
  VerdictFailures failures_;
  std::string outcomes_, reason_;
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

std::span<const MethodRateInfo> method_rate_infos() {
  return kRates;
}

std::vector<MethodRateInfo> method_rate_infos(const Study& study) {
  std::vector<MethodRateInfo> infos;
  std::copy_if(kRates.begin(), kRates.end(), std::back_inserter(infos),
               [&](const MethodRateInfo& info) { return has(study, info.of); });
  return infos;
}

std::span<const MethodEstimateInfo> method_estimate_infos() {
  return kEstimates;
}

std::vector<MethodEstimateInfo> method_estimate_infos(const Study& study) {
  std::vector<MethodEstimateInfo> infos;
  std::copy_if(kEstimates.begin(), kEstimates.end(), std::back_inserter(infos),
               [&](const MethodEstimateInfo& info) { return has(study, info.of); });
  return infos;
}

std::span<const ThresholdInfo> threshold_infos() {
  return kThresholds;
}

Collector<MethodRates> rate_collector(const Study& study, std::size_t method,
                                      const Calibration& calibration) {
  return collector_of(RateCounts(study, method, calibration));
}

std::vector<UnansweredPart> unanswered_parts(const Study& study, const MethodRates& rates) {
  std::vector<UnansweredPart> parts;
  if (study.calibration && rates.thresholds.not_mpm.loops == 0)
    parts.push_back(
        {"calibration", "no verdict on any calibration loop, so no rate at a calibrated threshold"});
  if (study.monitoring && rates.monitored_impact.total == 0 && rates.false_alarms_a_day.count == 0)
    parts.push_back({"windows", "no verdict on any window, so no delay and no alarms per day"});
  return parts;
}

bool answers_and_detects(const MethodRates& rates) {
  constexpr double kDetects = 0.5;
  const Rate& detected = rates.detected_impact.total > 0 ? rates.detected_impact : rates.detected;
  const bool answers = rates.answered.total > 0 && rates.answered.value >= kFewestAnswers;
  const bool detects = detected.total > 0 && detected.value >= kDetects;
  return answers && detects &&
         (rates.false_alarm_healthy.total == 0 || detected.value > rates.false_alarm_healthy.value);
}

Finding method_finding(const std::string& method, const std::string& name, const std::string& label,
                       const std::string& meaning) {
  return {.name = fmt::format("compare.{}.{}", method, name),
          .label = label,
          .meaning = fmt::format("{}: {}", method, meaning),
          .group = FindingGroup::method,
          .method = method};
}

std::vector<Finding> rows_of(const Study& study, const MethodRates& rates, const MethodDescription& method) {
  std::vector<Finding> rows;
  const auto like = [&](const char* name, const std::string& label, const char* meaning) {
    return method_finding(method.name, name, label, meaning);
  };
  for (const MethodRateInfo& info : method_rate_infos(study))
    rows.push_back(like(info.name, info.title, info.meaning).with(rates.*info.rate));
  rows.push_back(like("roc_area", "area under the ROC curve", "area under the ROC curve of its score")
                     .with(rates.roc.area, rates.roc_area, rates.roc.positives + rates.roc.negatives));
  rows.push_back(like("roc_area_impact", "area under the ROC curve, impact",
                      "area under the ROC curve of its score, faults with an impact against all other loops")
                     .with(rates.roc_impact.area, rates.roc_impact_area,
                           rates.roc_impact.positives + rates.roc_impact.negatives));
  for (const MethodEstimateInfo& info : method_estimate_infos(study)) {
    const Estimate& found = rates.*info.estimate;
    Finding row = like(info.name, info.title, info.meaning);
    row.has_interval = info.has_interval;
    rows.push_back(row.with(found.value, found.interval, found.count));
  }
  if (!study.calibration)
    return rows;
  for (const ThresholdInfo& info : threshold_infos()) {
    const CalibratedThreshold& threshold = rates.thresholds.*info.threshold;
    Finding row = like(info.name, info.name, info.meaning);
    row.has_interval = false;
    rows.push_back(row.with(threshold.value.value_or(kNone), {kNone, kNone}, threshold.loops));
  }
  return rows;
}

FalseAlarmMark false_alarm_mark(const MethodDescription& method, const MethodRates& rates) {
  const double stated = method.stated_false_alarms.value_or(kUsualFalseAlarms);
  const Rate& found = rates.false_alarm_healthy;
  if (found.total == 0 || found.interval.contains(stated))
    return FalseAlarmMark::none;
  return found.interval.lower > stated ? FalseAlarmMark::more : FalseAlarmMark::fewer;
}

namespace {

struct PairCounts {
  MethodPair pair;
  WorldPairs right_in = {};

  void add(const Study& study, const ExperimentRecord& record) {
    const AssessmentRecord& a = record.assessments[pair.first];
    const AssessmentRecord& b = record.assessments[pair.second];
    if (!a.answered() || !b.answered())
      return;
    const bool right = to_be_flagged(study, record, pair.truth);
    ++pair.loops;
    right_in.add(record.draw.world, a.flagged == right, b.flagged == right);
  }

  MethodPair result() const {
    MethodPair found = pair;
    found.test = right_in.mcnemar();
    return found;
  }
};

/// Corrects the p-values of the pairs of one truth. Pairs without a loop in common test nothing.
void correct(std::span<MethodPair> pairs) {
  std::vector<double> p;
  for (const MethodPair& pair : pairs)
    if (pair.loops > 0)
      p.push_back(pair.test.p_two_sided);
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (MethodPair& pair : pairs)
    if (pair.loops > 0)
      pair.p_holm = *next++;
}

constexpr std::array kPairTruths{FlagTruth::fault, FlagTruth::impact};

/// All pairs, those of one truth after those of another.
struct AllPairCounts {
  const Study& study;
  std::vector<PairCounts> pairs = {};

  void add(const ExperimentRecord& record) {
    for (PairCounts& pair : pairs)
      pair.add(study, record);
  }
  std::vector<MethodPair> result() const {
    std::vector<MethodPair> found;
    for (const PairCounts& pair : pairs)
      found.push_back(pair.result());
    const std::size_t of_truth = found.size() / kPairTruths.size();
    for (std::size_t begin = 0; begin < found.size(); begin += of_truth)
      correct(std::span(found).subspan(begin, of_truth));
    return found;
  }
};

}  // namespace

Collector<std::vector<MethodPair>> pair_collector(const Study& study, std::size_t methods) {
  AllPairCounts counts{study};
  for (const FlagTruth truth : kPairTruths)
    for (std::size_t first = 0; first < methods; ++first)
      for (std::size_t second = first + 1; second < methods; ++second)
        counts.pairs.push_back({{truth, first, second, 0, {}, 1.0}});
  return collector_of(std::move(counts));
}

}  // namespace mpm
