#include "results/gates/gate_check.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/run_change.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/statistics/holm.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/archive/campaign_differences.hpp"
#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// Names a question "METHOD.QUESTION", except for two that have kept names from before there were other
/// methods.
BaselineChanges baseline_changes(const Campaign& campaign, const MethodChange& method,
                                 const VerdictChange& verdict) {
  const std::string question = verdict.question->key;
  if (diagnoses(*campaign.methods[method.now].form)) {
    if (question == "located")
      return {"located", "located", verdict.changes};
    if (question == "source")
      return {"source_recognised", "source recognised", verdict.changes};
  }
  return {fmt::format("{}.{}", method.name, question),
          fmt::format("{}: {}", method.name, verdict.question->name), verdict.changes};
}

BaselineComparison compare(const Campaign& campaign, const Campaign& baseline, const std::string& archive) {
  const AssessmentForms forms = forms_of(campaign), baseline_forms = forms_of(baseline);
  const StudyRun before = study_run(baseline, baseline_forms), now = study_run(campaign, forms);
  const std::string where = fmt::format("baseline {}", archive);
  const RunPairing pairing = pair_runs(before, now);
  if (!pairing.paired())
    throw InputError(where, "runs that cannot be paired: " + pairing.obstacle,
                     fmt::format("a run of the study '{}' with seed {} with the same fault in each "
                                 "experiment",
                                 campaign.study.name, campaign.study.seed));
  if (pairing.loops < static_cast<std::int64_t>(now.records.size()))
    throw InputError(where, fmt::format("{} of the experiments that are checked", pairing.loops),
                     fmt::format("all {}", now.records.size()));
  const std::vector<MethodChange> methods = verdict_changes(before, now);
  if (methods.empty())
    throw InputError(where, fmt::format("verdicts of {}", fmt::join(method_names(baseline), ", ")),
                     fmt::format("those of one of the methods that are checked: {}",
                                 fmt::join(method_names(campaign), ", ")));
  BaselineComparison comparison{
      archive,
      fmt::format("mpmbench {} ({}), solver {}", baseline.info.mpmbench_version,
                  baseline.info.git_sha.empty() ? "unknown revision" : baseline.info.git_sha,
                  baseline.info.solver),
      campaign_differences(baseline, campaign), methods_alone(baseline, campaign)};
  for (std::string& method : methods_alone(campaign, baseline))
    comparison.not_compared.push_back(std::move(method));
  std::vector<BaselineChanges> questions;
  for (const MethodChange& method : methods)
    for (const VerdictChange& verdict : method.verdicts)
      questions.push_back(baseline_changes(campaign, method, verdict));
  comparison.questions = correct_questions(std::move(questions));
  return comparison;
}

void judge_changes(const BaselineChanges& question, const BaselineLimits& limits,
                   std::vector<GateResult>& results) {
  const JudgementChanges& changes = question.changes;
  const std::string of = fmt::format("baseline.{}", question.name);
  results.push_back(judge_number(of + ".p_worse",
                                 "p-value of lost against gained verdicts, corrected for all questions",
                                 question.p_worse, changes.pairs, limits.significance, kInfinity));
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

std::vector<BaselineChanges> correct_questions(std::vector<BaselineChanges> questions) {
  std::vector<double> p;
  for (const BaselineChanges& question : questions)
    if (question.changed())
      p.push_back(question.changes.test().p_worse);
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (BaselineChanges& question : questions)
    question.p_worse = question.changed() ? *next++ : 1.0;
  return questions;
}

std::optional<GateResult> judge_answers(const std::string& method, const VerdictFailures& failures,
                                        double minimum) {
  if (failures.asked == 0)
    return std::nullopt;
  const Finding finding{.name = fmt::format("answered.{}", method),
                        .label = {},
                        .meaning = "share of the loops on which it was asked that the method answered",
                        .method = method,
                        .has_interval = false};
  Gate gate{.name = finding.name, .minimum = minimum};
  gate.reason = finding.meaning;
  if (failures.failed > 0)
    gate.reason += "; it " + shown_text(failures_text(failures));
  return judge(gate, finding.with(rate(failures.asked - failures.failed, failures.asked)));
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
                .confidence = study.aggregate.confidence,
                .created = campaign.info.created,
                .seconds = campaign.info.seconds};
  // Without these gates a campaign could pass because the experiments that would fail a gate are missing.
  run.results = {
      judge_number("self_check", "1: the basis case is healthy; otherwise no number is meaningful",
                   campaign.basis.healthy ? 1.0 : 0.0, 1, 1.0, kInfinity),
      judge_number("experiments", "number of experiments", static_cast<double>(total.experiments),
                   total.experiments, static_cast<double>(file.minimum_experiments), kInfinity),
      judge_number("failed", "number of experiments without a result", static_cast<double>(total.failed),
                   total.experiments, -kInfinity, static_cast<double>(file.maximum_failed))};
  for (const MethodFindings& method : total.methods)
    if (!method.form->method().origin.empty())
      if (auto answers = judge_answers(method.name(), method.rates.failures, file.minimum_answered))
        run.results.push_back(*std::move(answers));
  if (file.baseline)
    run.baseline = compare(campaign, *baseline, file.baseline->archive.string());
  return judge_gates(std::move(run), file, total.rows);
}

}  // namespace mpm
