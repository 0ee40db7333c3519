#include "results/gates/gate_check.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

AggregateValue plain_value(std::string name, std::string description, double value, std::int64_t count) {
  return {std::move(name), std::move(description), value, {kNaN, kNaN}, count};
}

Gate limit(const AggregateValue& value, double minimum, double maximum) {
  Gate gate{value.name, minimum, maximum};
  gate.reason = value.description;
  return gate;
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Without these a campaign could pass because the experiments that would have failed a gate are missing.
void judge_campaign(const Campaign& campaign, const StudyAggregate& total, const GateFile& file,
                    std::vector<GateResult>& results) {
  const AggregateValue healthy =
      plain_value("self_check", "1: the basis case is healthy; otherwise no number means anything",
                  campaign.basis.healthy ? 1.0 : 0.0, 1);
  const AggregateValue experiments = plain_value("experiments", "number of experiments",
                                                 static_cast<double>(total.experiments), total.experiments);
  const AggregateValue failed = plain_value("failed", "number of experiments without a result",
                                            static_cast<double>(total.failed), total.experiments);
  results.push_back(judge(limit(healthy, 1.0, kNoLimit), healthy));
  results.push_back(
      judge(limit(experiments, static_cast<double>(file.minimum_experiments), kNoLimit), experiments));
  results.push_back(judge(limit(failed, -kNoLimit, static_cast<double>(file.maximum_failed)), failed));
}

void require_same_study(const Campaign& campaign, const Campaign& baseline, const std::string& archive) {
  if (campaign.study.source != baseline.study.source)
    throw InputError(fmt::format("baseline {}", archive),
                     fmt::format("another study file (study '{}')", baseline.study.name),
                     fmt::format("a run of exactly the same study file (study '{}'): only then are its "
                                 "experiments the same ones",
                                 campaign.study.name));
  if (campaign.study.seed != baseline.study.seed)
    throw InputError(fmt::format("baseline {}", archive), fmt::format("seed {}", baseline.study.seed),
                     fmt::format("the seed of the archive that is checked, {}", campaign.study.seed));
}

BaselineComparison compare(const Campaign& campaign, const Campaign& baseline, const std::string& archive) {
  require_same_study(campaign, baseline, archive);
  const auto source = [&](const ExperimentRecord& record) { return source_verdict(campaign.study, record); };
  try {
    return {archive, baseline.info, verdict_changes(baseline.records, campaign.records, location_verdict),
            verdict_changes(baseline.records, campaign.records, source)};
  } catch (const InputError& error) {
    throw InputError(fmt::format("baseline {}: {}", archive, error.what()));
  }
}

void judge_changes(const std::string& question, const VerdictChanges& changes, const BaselineLimits& limits,
                   std::vector<GateResult>& results) {
  const std::string of = "baseline." + question;
  const AggregateValue p_worse = plain_value(of + ".p_worse", "exact p-value of lost against gained verdicts",
                                             changes.test.p_worse, changes.pairs);
  results.push_back(judge(limit(p_worse, limits.significance, kNoLimit), p_worse));
  if (!limits.maximum_lost)
    return;
  const AggregateValue lost = plain_value(of + ".lost", "verdicts that were right in the baseline",
                                          static_cast<double>(changes.lost.size()), changes.pairs);
  results.push_back(judge(limit(lost, -kNoLimit, static_cast<double>(*limits.maximum_lost)), lost));
}

/// The numbers of the comparison of methods with the intervals of `study`; none without a comparison.
std::vector<AggregateValue> comparison_values(const Campaign& campaign, const Study& study) {
  if (!campaign.comparison)
    return {};
  return named_values(summarise(*campaign.comparison, campaign.records, study));
}

}  // namespace

bool GateCheck::stops(const GateResult& result) const {
  return result.outcome == GateOutcome::fail ||
         (result.outcome == GateOutcome::inconclusive && inconclusive == InconclusivePolicy::fail);
}

bool GateCheck::passed() const {
  return std::none_of(results.begin(), results.end(),
                      [this](const GateResult& result) { return stops(result); });
}

std::vector<std::string> gate_names(const Study& study) {
  std::vector<std::string> names;
  for (AggregateValue& value : named_values(aggregate(study, {})))
    names.push_back(std::move(value.name));
  return names;
}

std::vector<std::string> gate_names(const Campaign& campaign) {
  std::vector<std::string> names = gate_names(campaign.study);
  for (AggregateValue& value : comparison_values(campaign, campaign.study))
    names.push_back(std::move(value.name));
  return names;
}

GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline) {
  assert(file.baseline.has_value() == (baseline != nullptr));
  GateCheck check;
  check.inconclusive = file.inconclusive;
  Study study = campaign.study;
  study.aggregate.confidence = check.confidence = file.confidence.value_or(study.aggregate.confidence);
  const StudyAggregate total = aggregate(study, campaign.records);
  judge_campaign(campaign, total, file, check.results);
  std::vector<AggregateValue> values = named_values(total);
  for (AggregateValue& value : comparison_values(campaign, study))
    values.push_back(std::move(value));
  for (const Gate& gate : file.gates) {
    const auto value = std::find_if(values.begin(), values.end(),
                                    [&](const AggregateValue& entry) { return entry.name == gate.name; });
    assert(value != values.end());
    check.results.push_back(judge(gate, *value));
  }
  if (file.baseline) {
    check.baseline = compare(campaign, *baseline, file.baseline->archive.string());
    judge_changes("located", check.baseline->located, *file.baseline, check.results);
    judge_changes("source_recognised", check.baseline->source_recognised, *file.baseline, check.results);
  }
  return check;
}

}  // namespace mpm
