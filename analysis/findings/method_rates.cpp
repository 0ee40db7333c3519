#include "analysis/findings/method_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "analysis/methods/method_table.hpp"
#include "analysis/statistics/quantile.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The truth about one compared loop.
using Truths = std::vector<const ExperimentRecord*>;

Truths truths_of(const Comparison& comparison, std::span<const ExperimentRecord> records) {
  Truths truths;
  auto record = records.begin();
  for (const ComparedLoop& loop : comparison.loops) {
    record = std::find_if(record, records.end(), [&](const ExperimentRecord& candidate) {
      return candidate.draw.index == loop.experiment;
    });
    if (record == records.end())
      throw InputError("comparison", fmt::format("experiment {}", loop.experiment),
                       "experiments of the campaign, in their order");
    truths.push_back(&*record);
  }
  return truths;
}

bool has_fault(const ExperimentRecord& record) {
  return !is_faultless(record.draw.kind);
}

bool has_impact(const ExperimentRecord& record, const Study& study) {
  const Eigen::VectorXd& ivar = record.diagnosis.ivar_basis;
  return std::any_of(ivar.begin(), ivar.end(),
                     [&](double value) { return study.diagnosis.has_impact(value); });
}

/// Counts trials and hits.
struct Count {
  std::int64_t hits = 0, total = 0;

  void add(bool hit) {
    ++total;
    hits += hit ? 1 : 0;
  }
  Rate rate(double confidence) const { return mpm::rate(hits, total, confidence); }
};

/// The channel of the only mismatch, when it is one of an MV; none otherwise.
std::optional<Channel> mismatched_channel(const ExperimentRecord& record, const Study& study) {
  const std::vector<Mismatch>& mismatches = record.draw.mismatches;
  if (mismatches.size() != 1 || mismatches[0].input >= study.mv_count())
    return std::nullopt;
  return Channel{mismatches[0].cv, mismatches[0].input};
}

struct Counts {
  Count answered, detected, detected_mpm, detected_ud, detected_impact, flagged_without_impact,
      false_alarm_healthy, false_alarm_tuning, located, source, channel;
  std::vector<double> fault_scores, healthy_scores, milliseconds;

  void add(const MethodVerdict& verdict, const ExperimentRecord& truth, const Study& study,
           const AssessmentMethodInfo& method) {
    answered.add(verdict.status == AssessmentStatus::ok);
    if (verdict.status != AssessmentStatus::ok)
      return;
    if (!std::isnan(verdict.seconds))  // it would break the order for the median
      milliseconds.push_back(1e3 * verdict.seconds);
    if (truth.draw.kind == ExperimentKind::tuning) {
      false_alarm_tuning.add(verdict.flagged);
      return;
    }
    if (!has_fault(truth)) {
      healthy_scores.push_back(verdict.score);
      false_alarm_healthy.add(verdict.flagged);
      return;
    }
    fault_scores.push_back(verdict.score);
    detected.add(verdict.flagged);
    if (truth.draw.kind == ExperimentKind::mpm)
      detected_mpm.add(verdict.flagged);
    if (truth.draw.kind == ExperimentKind::ud)
      detected_ud.add(verdict.flagged);
    (has_impact(truth, study) ? detected_impact : flagged_without_impact).add(verdict.flagged);
    if (verdict.flagged)
      add_diagnosis(verdict, truth, study, method);
  }

  void add_diagnosis(const MethodVerdict& verdict, const ExperimentRecord& truth, const Study& study,
                     const AssessmentMethodInfo& method) {
    if (method.locates_cvs && truth.draw.true_cv() >= 0)
      located.add(verdict.located_cv == truth.draw.true_cv());
    if (method.tells_sources && truth.draw.kind != ExperimentKind::mpm_ud)
      source.add(verdict.source == truth.draw.kind);
    const std::optional<Channel> wrong = mismatched_channel(truth, study);
    if (method.names_channels && wrong)
      channel.add(std::find(verdict.flagged_channels.begin(), verdict.flagged_channels.end(), *wrong) !=
                  verdict.flagged_channels.end());
  }
};

MethodRates rates_of(std::size_t method, const Comparison& comparison, const Truths& truths,
                     const Study& study) {
  const AssessmentMethodInfo& info = assessment_method(comparison.methods[method]);
  Counts counts;
  for (std::size_t i = 0; i < truths.size(); ++i)
    counts.add(comparison.loops[i].verdicts[method], *truths[i], study, info);
  const double confidence = study.aggregate.confidence;
  MethodRates rates{.method = info.name,
                    .reason = comparison.reasons[method],
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

bool to_be_flagged(const ExperimentRecord& record, FlagTruth truth, const Study& study) {
  return has_fault(record) && (truth == FlagTruth::fault || has_impact(record, study));
}

MethodPair paired(FlagTruth truth, std::size_t first, std::size_t second, const Comparison& comparison,
                  const Truths& truths, const Study& study) {
  MethodPair pair{truth, first, second, 0, {}};
  std::int64_t lost = 0, gained = 0;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const MethodVerdict& a = comparison.loops[i].verdicts[first];
    const MethodVerdict& b = comparison.loops[i].verdicts[second];
    if (a.status != AssessmentStatus::ok || b.status != AssessmentStatus::ok)
      continue;
    const bool right = to_be_flagged(*truths[i], truth, study);
    ++pair.loops;
    lost += a.flagged == right && b.flagged != right ? 1 : 0;
    gained += a.flagged != right && b.flagged == right ? 1 : 0;
  }
  pair.test = mcnemar_test(lost, gained);
  return pair;
}

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

std::string_view to_string(FlagTruth truth) {
  return truth == FlagTruth::fault ? "fault" : "impact";
}

std::span<const MethodRateInfo> method_rate_infos() {
  return kRates;
}

ComparisonSummary summarise(const Comparison& comparison, std::span<const ExperimentRecord> records,
                            const Study& study) {
  const Truths truths = truths_of(comparison, records);
  ComparisonSummary summary;
  for (std::size_t method = 0; method < comparison.methods.size(); ++method)
    summary.methods.push_back(rates_of(method, comparison, truths, study));
  for (const FlagTruth truth : {FlagTruth::fault, FlagTruth::impact})
    for (std::size_t first = 0; first < comparison.methods.size(); ++first)
      for (std::size_t second = first + 1; second < comparison.methods.size(); ++second)
        summary.pairs.push_back(paired(truth, first, second, comparison, truths, study));
  return summary;
}

std::vector<AggregateValue> named_values(const ComparisonSummary& summary) {
  std::vector<AggregateValue> values;
  for (const MethodRates& method : summary.methods) {
    for (const MethodRateInfo& info : method_rate_infos()) {
      const Rate& rate = method.*info.rate;
      values.push_back({fmt::format("compare.{}.{}", method.method, info.name),
                        fmt::format("{}: {}", method.method, info.meaning), rate.value, rate.interval,
                        rate.total});
    }
    values.push_back({fmt::format("compare.{}.roc_area", method.method),
                      fmt::format("{}: area under the ROC curve of its score", method.method),
                      method.roc.area, method.roc_area, method.roc.positives + method.roc.negatives});
  }
  return values;
}

}  // namespace mpm
