#include "results/gates/gate_check.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "analysis/findings/run_change.hpp"
#include "analysis/methods/method_table.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

Question question_of(const Study& study, Correctness (Judgement::*of)() const) {
  return [&study, of](const ExperimentRecord& record) {
    const AssessmentRecord* const chain = record.diagnosed();
    return chain == nullptr ? Correctness::not_judged : (judge(study, record, *chain).*of)();
  };
}

BaselineComparison compare(const Campaign& campaign, const Campaign& baseline, const std::string& archive) {
  const AssessmentForms forms = forms_of(campaign), baseline_forms = forms_of(baseline);
  const StudyRun before = study_run(baseline, baseline_forms), now = study_run(campaign, forms);
  const std::string where = fmt::format("baseline {}", archive);
  for (const Campaign* run : {&campaign, &baseline})
    if (chain_place(*run) == run->methods.size())
      throw InputError(
          where, "no verdicts of the chain to compare in one of the two archives",
          "two archives that a method with the diagnosis of the thesis, such as botelho, has assessed");
  const RunPairing pairing = pair_runs(before, now);
  if (!pairing.paired())
    throw InputError(where, "runs that cannot be paired: " + pairing.obstacle,
                     fmt::format("a run of the study '{}' with seed {} in which the same is wrong in each "
                                 "experiment",
                                 campaign.study.name, campaign.study.seed));
  if (pairing.loops < static_cast<std::int64_t>(now.records.size()))
    throw InputError(where, fmt::format("{} of the experiments that are checked", pairing.loops),
                     fmt::format("all {}", now.records.size()));
  const auto changes = [&](Correctness (Judgement::*of)() const) {
    return judgement_changes({before.records, question_of(baseline.study, of)},
                             {now.records, question_of(campaign.study, of)});
  };
  return {archive,
          fmt::format("mpmbench {} ({}), solver {}", baseline.info.mpmbench_version,
                      baseline.info.git_sha.empty() ? "unknown revision" : baseline.info.git_sha,
                      baseline.info.solver),
          baseline.study.source == campaign.study.source ? std::vector<StudyDifference>()
                                                         : study_differences(baseline.study, campaign.study),
          {{"located", "located", changes(&Judgement::location)},
           {"source_recognised", "source recognised", changes(&Judgement::source)}}};
}

void judge_changes(const BaselineChanges& question, const BaselineLimits& limits,
                   std::vector<GateResult>& results) {
  const JudgementChanges& changes = question.changes;
  const std::string of = fmt::format("baseline.{}", question.name);
  results.push_back(judge_number(of + ".p_worse", "exact p-value of lost against gained verdicts",
                                 changes.test().p_worse, changes.pairs, limits.significance, kInfinity));
  if (limits.maximum_lost)
    results.push_back(judge_number(of + ".lost", "verdicts that were right in the baseline",
                                   static_cast<double>(changes.lost.size()), changes.pairs, -kInfinity,
                                   static_cast<double>(*limits.maximum_lost)));
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
  return findings_of(campaign).rows;
}

GateResult judge_number(const std::string& name, const std::string& meaning, double value, std::int64_t count,
                        double minimum, double maximum) {
  const Finding finding{.name = name, .label = {}, .meaning = meaning, .has_interval = false};
  Gate gate{name, minimum, maximum};
  gate.reason = meaning;
  return judge(gate, finding.with(value, {kNaN, kNaN}, count));
}

GateCheck judge_gates(GateCheck run, const GateFile& file, const std::vector<Finding>& findings) {
  assert(file.baseline.has_value() == run.baseline.has_value());
  run.inconclusive = file.inconclusive;
  for (const Gate& gate : file.gates) {
    const Finding* const finding = find_finding(findings, gate.name);
    assert(finding != nullptr);
    run.results.push_back(judge(gate, *finding));
  }
  if (run.baseline)
    for (const BaselineChanges& question : run.baseline->questions)
      judge_changes(question, *file.baseline, run.results);
  return run;
}

GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline) {
  Study study = campaign.study;
  study.aggregate.confidence = file.confidence.value_or(study.aggregate.confidence);
  const StudyFindings total =
      study_findings(study, forms_of(campaign), records_of(campaign), campaign.calibration);
  GateCheck run{.name = study.name,
                .title = {},
                .properties = {{"seed", fmt::format("{}", study.seed)},
                               {"solver", campaign.info.solver},
                               {"mpmbench_version", campaign.info.mpmbench_version},
                               {"git_sha", campaign.info.git_sha}},
                .confidence = study.aggregate.confidence};
  // Without these a campaign could pass because the experiments that would have failed a gate are missing.
  run.results = {
      judge_number("self_check", "1: the basis case is healthy; otherwise no number has a meaning",
                   campaign.basis.healthy ? 1.0 : 0.0, 1, 1.0, kInfinity),
      judge_number("experiments", "number of experiments", static_cast<double>(total.experiments),
                   total.experiments, static_cast<double>(file.minimum_experiments), kInfinity),
      judge_number("failed", "number of experiments without a result", static_cast<double>(total.failed),
                   total.experiments, -kInfinity, static_cast<double>(file.maximum_failed))};
  if (file.baseline)
    run.baseline = compare(campaign, *baseline, file.baseline->archive.string());
  return judge_gates(std::move(run), file, total.rows);
}

}  // namespace mpm
