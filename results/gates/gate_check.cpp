#include "results/gates/gate_check.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "analysis/methods/method_table.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

Finding plain_value(std::string name, std::string meaning, double value, std::int64_t count) {
  const Finding finding{
      .name = std::move(name), .label = {}, .meaning = std::move(meaning), .has_interval = false};
  return finding.with(value, {kNaN, kNaN}, count);
}

Gate limit(const Finding& value, double minimum, double maximum) {
  Gate gate{value.name, minimum, maximum};
  gate.reason = value.meaning;
  return gate;
}

constexpr double kNoLimit = kInfinity;

/// Without these a campaign could pass because the experiments that would have failed a gate are missing.
void judge_campaign(const Campaign& campaign, const StudyFindings& total, const GateFile& file,
                    std::vector<GateResult>& results) {
  const Finding healthy =
      plain_value("self_check", "1: the basis case is healthy; otherwise no number has a meaning",
                  campaign.basis.healthy ? 1.0 : 0.0, 1);
  const Finding experiments = plain_value("experiments", "number of experiments",
                                          static_cast<double>(total.experiments), total.experiments);
  const Finding failed = plain_value("failed", "number of experiments without a result",
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
  const auto question = [&](Correctness (Judgement::*of)() const) {
    return [&study = campaign.study, of](const ExperimentRecord& record) {
      const AssessmentRecord* const chain = record.diagnosed();
      return chain == nullptr ? Correctness::not_judged : (judge(study, record, *chain).*of)();
    };
  };
  try {
    return {archive,
            baseline.info,
            {{"located", "located",
              judgement_changes(records_of(baseline), records_of(campaign), question(&Judgement::location))},
             {"source_recognised", "source recognised",
              judgement_changes(records_of(baseline), records_of(campaign), question(&Judgement::source))}}};
  } catch (const InputError& error) {
    throw InputError(fmt::format("baseline {}: {}", archive, error.what()));
  }
}

void judge_changes(const BaselineChanges& question, const BaselineLimits& limits,
                   std::vector<GateResult>& results) {
  const JudgementChanges& changes = question.changes;
  const std::string of = fmt::format("baseline.{}", question.name);
  const Finding p_worse = plain_value(of + ".p_worse", "exact p-value of lost against gained verdicts",
                                      changes.test.p_worse, changes.pairs);
  results.push_back(judge(limit(p_worse, limits.significance, kNoLimit), p_worse));
  if (!limits.maximum_lost)
    return;
  const Finding lost = plain_value(of + ".lost", "verdicts that were right in the baseline",
                                   static_cast<double>(changes.lost.size()), changes.pairs);
  results.push_back(judge(limit(lost, -kNoLimit, static_cast<double>(*limits.maximum_lost)), lost));
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

const BaselineChanges* BaselineComparison::of(const GateResult& result) const {
  for (const BaselineChanges& question : questions)
    for (const char* number : {"p_worse", "lost"})
      if (result.gate.name == fmt::format("baseline.{}.{}", question.name, number))
        return &question;
  return nullptr;
}

std::vector<Finding> gate_findings(const Study& study) {
  return study_findings(study, assessment_forms(study, study_methods(study)), {}).rows;
}

std::vector<Finding> gate_findings(const Campaign& campaign) {
  return study_findings(campaign.study, forms_of(campaign), {}).rows;
}

GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline) {
  assert(file.baseline.has_value() == (baseline != nullptr));
  GateCheck check;
  check.inconclusive = file.inconclusive;
  Study study = campaign.study;
  study.aggregate.confidence = check.confidence = file.confidence.value_or(study.aggregate.confidence);
  const StudyFindings total =
      study_findings(study, forms_of(campaign), records_of(campaign), campaign.calibration);
  judge_campaign(campaign, total, file, check.results);
  for (const Gate& gate : file.gates) {
    const Finding* const finding = find_finding(total.rows, gate.name);
    assert(finding != nullptr);
    check.results.push_back(judge(gate, *finding));
  }
  if (file.baseline) {
    check.baseline = compare(campaign, *baseline, file.baseline->archive.string());
    for (const BaselineChanges& question : check.baseline->questions)
      judge_changes(question, *file.baseline, check.results);
  }
  return check;
}

}  // namespace mpm
