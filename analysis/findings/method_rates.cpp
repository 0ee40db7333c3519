#include "analysis/findings/method_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kNone = kNaN;

/// Counts trials and hits.
struct Count {
  std::int64_t hits = 0, total = 0;

  void add(bool hit) {
    ++total;
    hits += hit ? 1 : 0;
  }
  void add(Correctness correctness) {
    if (correctness != Correctness::not_judged)
      add(correctness == Correctness::right);
  }
  Rate rate(double confidence) const { return mpm::rate(hits, total, confidence); }
};

struct Counts {
  Count answered, detected, detected_mpm, detected_ud, detected_impact, flagged_without_impact,
      false_alarm_healthy, false_alarm_tuning, located, source, channel;
  std::vector<double> fault_scores, healthy_scores, milliseconds;

  void add(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
    answered.add(said.answered());
    if (!said.answered())
      return;
    if (!std::isnan(said.milliseconds))  // it would break the order for the median
      milliseconds.push_back(said.milliseconds);
    const ExperimentKind kind = record.draw.kind;
    if (kind == ExperimentKind::tuning) {
      false_alarm_tuning.add(said.flagged);
      return;
    }
    if (is_faultless(kind)) {
      healthy_scores.push_back(said.score);
      false_alarm_healthy.add(said.flagged);
      return;
    }
    fault_scores.push_back(said.score);
    detected.add(said.flagged);
    if (kind == ExperimentKind::mpm)
      detected_mpm.add(said.flagged);
    if (kind == ExperimentKind::ud)
      detected_ud.add(said.flagged);
    (has_impact(study.diagnosis, record) ? detected_impact : flagged_without_impact).add(said.flagged);
    if (!said.flagged)
      return;
    const Judgement judgement = judge(study, record, said);
    located.add(judgement.predicted_cv);
    source.add(judgement.predicted_source);
    channel.add(judgement.channel);
  }
};

constexpr std::array<MethodRateInfo, 11> kRates{{
    {"answered", "answered", "of all loops those on which the method gave a verdict", &MethodRates::answered},
    {"detected", "detected", "of the loops with a fault those that are flagged", &MethodRates::detected},
    {"detected_mpm", "detected, mismatch", "of the loops with a mismatch alone those that are flagged",
     &MethodRates::detected_mpm},
    {"detected_ud", "detected, disturbance", "of the loops with a disturbance alone those that are flagged",
     &MethodRates::detected_ud},
    {"detected_impact", "detected, with impact",
     "of the loops with a fault that has an impact those that are flagged", &MethodRates::detected_impact},
    {"flagged_without_impact", "flagged, no impact",
     "of the loops with a fault that has no impact those that are flagged",
     &MethodRates::flagged_without_impact},
    {"false_alarm_healthy", "false alarms, healthy",
     "of the loops without a fault and with the tuning of the design those that are flagged",
     &MethodRates::false_alarm_healthy},
    {"false_alarm_tuning", "false alarms, bad tuning",
     "of the loops without a fault and with bad tuning those that are flagged",
     &MethodRates::false_alarm_tuning},
    {"located", "CV located",
     "of the flagged loops in which a fault affects one CV those in which this CV has the largest score",
     &MethodRates::located},
    {"source", "source right",
     "of the flagged loops with a mismatch or a disturbance alone those whose located CV has the right "
     "source",
     &MethodRates::source},
    {"channel", "channel named",
     "of the flagged loops with one mismatch of an MV those in which its channel is named",
     &MethodRates::channel},
}};

}  // namespace

std::span<const MethodRateInfo> method_rate_infos() {
  return kRates;
}

MethodRates method_rates(const Study& study, std::size_t method, std::span<const ExperimentRecord> records) {
  Counts counts;
  std::string reason;
  for (const ExperimentRecord& record : records) {
    const AssessmentRecord& said = record.assessments[method];
    if (said.status == AssessmentStatus::not_assessed)
      continue;
    counts.add(study, record, said);
    if (reason.empty())
      reason = said.reason;
  }
  const double confidence = study.aggregate.confidence;
  MethodRates rates{.reason = std::move(reason),
                    .answered = counts.answered.rate(confidence),
                    .detected = counts.detected.rate(confidence),
                    .detected_mpm = counts.detected_mpm.rate(confidence),
                    .detected_ud = counts.detected_ud.rate(confidence),
                    .detected_impact = counts.detected_impact.rate(confidence),
                    .flagged_without_impact = counts.flagged_without_impact.rate(confidence),
                    .false_alarm_healthy = counts.false_alarm_healthy.rate(confidence),
                    .false_alarm_tuning = counts.false_alarm_tuning.rate(confidence),
                    .located = counts.located.rate(confidence),
                    .source = counts.source.rate(confidence),
                    .channel = counts.channel.rate(confidence),
                    .roc = roc_curve(counts.fault_scores, counts.healthy_scores),
                    .roc_area = {kNone, kNone},
                    .milliseconds = kNone};
  if (rates.roc.defined())
    rates.roc_area = area_interval(rates.roc.area, rates.roc.positives, rates.roc.negatives, confidence);
  if (!counts.milliseconds.empty()) {
    std::sort(counts.milliseconds.begin(), counts.milliseconds.end());
    rates.milliseconds = sorted_quantile(counts.milliseconds, 0.5);
  }
  return rates;
}

std::vector<Finding> rows_of(const MethodRates& rates, const MethodDescription& method) {
  std::vector<Finding> rows;
  const auto like = [&](const char* name, const std::string& label, const char* meaning) {
    return Finding{.name = fmt::format("compare.{}.{}", method.name, name),
                   .label = label,
                   .meaning = fmt::format("{}: {}", method.name, meaning),
                   .group = FindingGroup::method,
                   .method = method.name};
  };
  for (const MethodRateInfo& info : method_rate_infos())
    rows.push_back(like(info.name, info.title, info.meaning).with(rates.*info.rate));
  rows.push_back(like("roc_area", "area under the ROC curve", "area under the ROC curve of its score")
                     .with(rates.roc.area, rates.roc_area, rates.roc.positives + rates.roc.negatives));
  return rows;
}

namespace {

MethodPair paired(const Study& study, FlagTruth truth, std::size_t first, std::size_t second,
                  std::span<const ExperimentRecord> records) {
  MethodPair pair{truth, first, second, 0, {}};
  std::int64_t lost = 0, gained = 0;
  for (const ExperimentRecord& record : records) {
    const AssessmentRecord& a = record.assessments[first];
    const AssessmentRecord& b = record.assessments[second];
    if (!a.answered() || !b.answered())
      continue;
    const bool right = to_be_flagged(study, record, truth);
    ++pair.loops;
    lost += a.flagged == right && b.flagged != right ? 1 : 0;
    gained += a.flagged != right && b.flagged == right ? 1 : 0;
  }
  pair.test = mcnemar_test(lost, gained);
  return pair;
}

}  // namespace

std::vector<MethodPair> method_pairs(const Study& study, std::size_t methods,
                                     std::span<const ExperimentRecord> records) {
  std::vector<MethodPair> pairs;
  for (const FlagTruth truth : {FlagTruth::fault, FlagTruth::impact})
    for (std::size_t first = 0; first < methods; ++first)
      for (std::size_t second = first + 1; second < methods; ++second)
        pairs.push_back(paired(study, truth, first, second, records));
  return pairs;
}

}  // namespace mpm
