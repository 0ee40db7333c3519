#include "analysis/findings/study_findings.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/chain_numbers.hpp"
#include "analysis/methods/method_table.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

void append(std::vector<Finding>&& rows, std::vector<Finding>& to) {
  for (Finding& row : rows)
    to.push_back(std::move(row));
}

std::vector<Finding> rows_of(const std::string& parameter, const char* words, const S0Change& change) {
  const std::string of = fmt::format("{} of S0 within tolerance", words);
  const Finding largest{.name = parameter + ".largest_change",
                        .label = fmt::format("largest relative change of Ivar_{{diag}}, {}", of),
                        .meaning = fmt::format("largest relative change of Ivar_diag, {}", of),
                        .group = FindingGroup::s0,
                        .method = std::string(kChainMethod),
                        .has_interval = false};
  const Finding within{.name = parameter + ".within_band",
                       .label = fmt::format("Ivar_{{diag}} stays in band, {}", of),
                       .meaning = fmt::format("experiments whose Ivar_diag stays in band, {}", of),
                       .group = FindingGroup::s0,
                       .method = std::string(kChainMethod)};
  return {largest.with(change.largest, {kNaN, kNaN}, change.within_band.total),
          within.with(change.within_band)};
}

/// The rows of the chain have no prefix: they are what the thesis reports.
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
    if (findings.source_area)
      rows.push_back(row_of(*findings.source_area));
    append(rows_of(findings.dominance), rows);
    if (findings.s0_changes) {
      append(rows_of("s0_time_constant", "time constant", findings.s0_changes->time_constant), rows);
      append(rows_of("s0_damping", "damping", findings.s0_changes->damping), rows);
    }
    for (const FalseAlarms& group : chain->false_alarms)
      append(rows_of(group, chain->name()), rows);
  }
  for (const MethodFindings& method : findings.methods)
    if (method.name() != kChainMethod)
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
  return of(kChainMethod);
}

StudyFindings study_findings(const Study& study, const AssessmentForms& forms, const RecordRange& records,
                             const Calibration& calibration) {
  StudyFindings findings;
  std::vector<MethodCollector> methods;
  const auto pairs = pair_collector(study, forms.size());
  std::optional<Collector<std::vector<DominanceBin>>> dominance;
  std::optional<Collector<SourceArea>> source_area;
  std::optional<Collector<S0Changes>> s0_changes;
  for (std::size_t method = 0; method < forms.size(); ++method) {
    methods.push_back({kind_collector(study, *forms[method], method), false_alarm_collector(study, method),
                       rate_collector(study, method, calibration)});
    if (forms[method]->method().name != kChainMethod)
      continue;
    dominance = dominance_collector(study, method);
    if (study.experiments.mpm > 0 && study.experiments.ud > 0)
      source_area = source_area_collector(study, method);
    if (!study.s0_perturbation.multipliers.empty())
      s0_changes = s0_change_collector(study);
  }

  records.each([&](const ExperimentRecord& record) {
    findings.add(record);
    findings.assessed += std::any_of(record.assessments.begin(), record.assessments.end(), looked_at) ? 1 : 0;
    for (const MethodCollector& method : methods)
      method.add(record);
    pairs.add(record);
    if (dominance)
      dominance->add(record);
    if (source_area)
      source_area->add(record);
    if (s0_changes)
      s0_changes->add(record);
  });

  findings.finish(study.aggregate.confidence);
  for (std::size_t method = 0; method < forms.size(); ++method)
    findings.methods.push_back(std::exchange(methods[method], {}).findings(forms[method]));
  findings.pairs = pairs.result();
  if (dominance)
    findings.dominance = dominance->result();
  if (source_area)
    findings.source_area = source_area->result();
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
       study_findings(study, assessment_forms(study, assessment_method_names()), {}).rows)
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
                       fmt::format("{}", fmt::join(names, ", ")));
}

}  // namespace mpm
