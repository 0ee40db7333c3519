#include "analysis/findings/study_findings.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/loop_outcome.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

void append(std::vector<Finding>&& rows, std::vector<Finding>& to) {
  for (Finding& row : rows)
    to.push_back(std::move(row));
}

std::vector<Finding> rows_of(const std::string& parameter, const char* words, const std::string& method,
                             const S0Change& change) {
  const std::string of = fmt::format("{} of S0 within tolerance", words);
  const Finding largest{.name = parameter + ".largest_change",
                        .label = fmt::format("largest relative change of Ivar_{{diag}}, {}", of),
                        .meaning = fmt::format("largest relative change of Ivar_diag, {}", of),
                        .group = FindingGroup::s0,
                        .method = method,
                        .has_interval = false};
  const Finding within{.name = parameter + ".within_band",
                       .label = fmt::format("Ivar_{{diag}} stays in band, {}", of),
                       .meaning = fmt::format("experiments whose Ivar_diag stays in band, {}", of),
                       .group = FindingGroup::s0,
                       .method = method};
  return {largest.with(change.largest, {kNaN, kNaN}, change.within_band.total),
          within.with(change.within_band)};
}

/// Adds the findings of the chain over all kinds together, and over the loops without a fault.
void add_together(const Study& study, StudyFindings& findings) {
  const double confidence = study.aggregate.confidence;
  findings.right_scenarios = rate(findings.right_scenarios.hits, findings.right_scenarios.total, confidence);
  const MethodFindings* const chain = findings.chain();
  if (chain == nullptr)
    return;
  findings.located = over_kinds(chain->kinds, &KindFindings::located, confidence);
  findings.source_recognised = over_kinds(chain->kinds, &KindFindings::source_recognised, confidence);
  std::int64_t hits = 0, total = 0;
  for (const FalseAlarms& group : chain->false_alarms)
    if (!group.parameter) {
      hits += group.false_alarm.hits;
      total += group.false_alarm.total;
    }
  findings.false_alarm = rate(hits, total, confidence);
}

/// Returns the rows of the findings of add_together().
std::vector<Finding> together_rows(const Study& study, const StudyFindings& findings) {
  std::vector<Finding> rows;
  const auto add = [&](const char* name, const char* label, const char* meaning, const Rate& found) {
    rows.push_back(
        Finding{.name = name, .label = label, .meaning = meaning, .prominence = Prominence::detail}.with(
            found));
  };
  if (study.names_scenarios()) {
    add("right_scenarios", "scenarios judged rightly", "named scenarios whose every CV and source is right",
        findings.right_scenarios);
    return rows;
  }
  if (!findings.chain()->kinds.empty()) {
    add("located", "located", "flagged loops of all kinds whose CV is located", findings.located);
    add("source_recognised", "source recognised", "loops with one fault whose source is recognised",
        findings.source_recognised);
  }
  if (!findings.chain()->false_alarms.empty())
    add("false_alarm", "false alarm", "loops in which model and plant agree that are flagged",
        findings.false_alarm);
  return rows;
}

/// Returns all rows. The names of the chain's rows have no prefix, because the thesis reports these numbers.
std::vector<Finding> all_rows(const Study& study, const StudyFindings& findings) {
  const Finding infeasible{.name = "infeasible",
                           .label = "infeasible",
                           .meaning = "share of infeasible experiments",
                           .group = FindingGroup::study,
                           .prominence = Prominence::headline};
  const auto count = [](const char* name, const char* meaning, std::int64_t experiments) {
    return counted({.name = name, .label = name, .meaning = meaning, .prominence = Prominence::detail},
                   experiments);
  };
  std::vector<Finding> rows{count("experiments", "number of experiments", findings.experiments),
                            count("failed", "number of experiments without a result", findings.failed),
                            infeasible.with(findings.infeasible)};
  if (findings.unstable.total > 0)
    rows.push_back(unstable_row(findings, Finding{.name = "unstable", .label = "", .meaning = ""}));
  if (study.diagnosis.unstable == UnstableLoops::exclude)
    rows.push_back(count("excluded", "number of unstable loops that are left out", findings.excluded));
  if (const MethodFindings* const chain = findings.chain()) {
    for (const KindFindings& kind : chain->kinds)
      append(rows_of(kind, study, *chain->form, ""), rows);
    append(together_rows(study, findings), rows);
    if (findings.source_curve)
      append(rows_of(*findings.source_curve), rows);
    append(rows_of(findings.dominance), rows);
    if (findings.s0_changes) {
      append(rows_of("s0_time_constant", "time constant", chain->name(), findings.s0_changes->time_constant),
             rows);
      append(rows_of("s0_damping", "damping", chain->name(), findings.s0_changes->damping), rows);
    }
    for (const FalseAlarms& group : chain->false_alarms)
      append(rows_of(group, chain->name()), rows);
  }
  for (const MethodFindings& method : findings.methods)
    if (&method != findings.chain())
      for (const KindFindings& kind : method.kinds)
        append(rows_of(kind, study, *method.form, method.name() + "."), rows);
  for (const MethodFindings& method : findings.methods)
    append(rows_of(study, method.rates, method.form->method()), rows);
  return rows;
}

bool looked_at(const AssessmentRecord& said) {
  return said.status != AssessmentStatus::not_assessed;
}

struct MethodCollector {
  Collector<std::vector<KindFindings>> kinds;
  Collector<std::vector<FalseAlarms>> false_alarms;
  Collector<MethodRates> rates;

  void add(const ExperimentRecord& record) const {
    kinds.add(record);
    false_alarms.add(record);
    rates.add(record);
  }
  MethodFindings findings(const std::shared_ptr<const AssessmentForm>& form) const {
    return {form, kinds.result(), false_alarms.result(), rates.result()};
  }
};

}  // namespace

const MethodFindings* StudyFindings::of(std::string_view method) const {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [method](const MethodFindings& each) { return each.name() == method; });
  return found == methods.end() ? nullptr : &*found;
}

const MethodFindings* StudyFindings::chain() const {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [](const MethodFindings& each) { return diagnoses(*each.form); });
  return found == methods.end() ? nullptr : &*found;
}

StudyFindings study_findings(const Study& study, const AssessmentForms& forms, const RecordRange& records,
                             const Calibration& calibration) {
  StudyFindings findings;
  std::vector<MethodCollector> methods;
  const auto pairs = pair_collector(study, forms.size());
  std::optional<Collector<std::vector<DominanceBin>>> dominance;
  std::optional<Collector<SourceCurve>> source_curve;
  std::optional<Collector<S0Changes>> s0_changes;
  for (std::size_t method = 0; method < forms.size(); ++method) {
    methods.push_back({kind_collector(study, *forms[method], method), false_alarm_collector(study, method),
                       rate_collector(study, method, calibration)});
    if (dominance || !diagnoses(*forms[method]))
      continue;
    dominance = dominance_collector(study, method);
    if (study.experiments.mpm > 0 && study.experiments.ud > 0)
      source_curve = source_curve_collector(study, method);
    if (!study.s0_perturbation.multipliers.empty())
      s0_changes = s0_change_collector(study);
  }

  records.each([&](const ExperimentRecord& record) {
    findings.add(record);
    const bool assessed = std::any_of(record.assessments.begin(), record.assessments.end(), looked_at);
    findings.assessed += assessed ? 1 : 0;
    findings.truths.push_back(assessed ? std::optional(truth_of(study, record)) : std::nullopt);
    findings.worlds.push_back(record.draw.world);
    for (const MethodCollector& method : methods)
      method.add(record);
    pairs.add(record);
    if (dominance)
      dominance->add(record);
    if (source_curve)
      source_curve->add(record);
    if (const AssessmentRecord* const said = record.diagnosed();
        study.names_scenarios() && said != nullptr && said->answered()) {
      ++findings.right_scenarios.total;
      findings.right_scenarios.hits += judge(study, record, *said).wrong() ? 0 : 1;
    }
    if (s0_changes)
      s0_changes->add(record);
  });

  findings.finish(study.aggregate.confidence);
  for (std::size_t method = 0; method < forms.size(); ++method)
    findings.methods.push_back(std::exchange(methods[method], {}).findings(forms[method]));
  findings.pairs = pairs.result();
  if (dominance)
    findings.dominance = dominance->result();
  if (source_curve)
    findings.source_curve = source_curve->result();
  add_together(study, findings);
  if (s0_changes)
    findings.s0_changes = s0_changes->result();
  findings.rows = all_rows(study, findings);
  for (Finding& row : findings.rows)
    for (const ReportedValue& reported : study.reported)
      if (reported.name == row.name) {
        row.reported = reported.value;
        row.reported_of = reported.of;
      }
  return findings;
}

std::vector<std::string> finding_names(Study study) {
  study.experiments = {.mpm = 1, .ud = 1, .mpm_ud = 1, .healthy = 1, .tuning = 1, .other = 1};
  study.s0_perturbation.multipliers = {1.0};
  study.calibration.emplace();
  std::vector<std::string> names;
  for (const Finding& row :
       study_findings(study, assessment_forms(study, method_table(study.assessment).names()), {}).rows)
    names.push_back(row.name);
  return names;
}

void check_reported(const Study& study) {
  if (study.reported.empty())
    return;
  const std::vector<std::string> names = finding_names(study);
  for (const ReportedValue& reported : study.reported)
    if (std::find(names.begin(), names.end(), reported.name) == names.end())
      throw InputError(reported.where, "unknown finding " + with_nearest(reported.name, names),
                       allowed_names(names));
}

}  // namespace mpm
