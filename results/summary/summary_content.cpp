#include "results/summary/summary_content.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "results/text/experiment_text.hpp"

namespace mpm {

namespace {

std::vector<KindCount> kinds_of(const Study& study) {
  std::vector<KindCount> counts;
  if (study.names_scenarios())
    return counts;
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud,
                                    ExperimentKind::healthy, ExperimentKind::tuning, ExperimentKind::other})
    if (study.experiments.of(kind) > 0)
      counts.push_back({kind, 0});
  return counts;
}

}  // namespace

std::string kinds_text(const Study& study, const std::vector<KindCount>& kinds) {
  std::string text = study.names_scenarios() ? "named scenarios" : "";
  for (const KindCount& count : kinds)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.experiments, kind_name(count.kind));
  return text;
}

std::string endings_text(const Study& study, const Endings& endings) {
  std::string text = fmt::format("{} infeasible, {} failed", endings.infeasible.hits, endings.failed);
  if (endings.unstable.total > 0)
    text += fmt::format(", {} of {} loops unstable", endings.unstable.hits, endings.unstable.total);
  if (study.diagnosis.unstable == UnstableLoops::exclude)
    text += fmt::format(", {} left out", endings.excluded);
  return text;
}

SummaryContent summary_content(const Campaign& campaign, const StudyFindings& findings, std::size_t most) {
  const Study& study = campaign.study;
  SummaryContent parts(findings);
  std::optional<Collector<std::vector<S0Curve>>> s0_curves;
  if (!study.s0_perturbation.multipliers.empty()) {
    s0_curves = s0_curve_collector(study);
    parts.s0_fits = diagonal_fits(campaign.basis.sensitivity, study.controller.sample_time);
    parts.structure_fits = structure_fits(study, campaign.basis);
  }
  parts.audit = summarise(campaign.audit);
  parts.kinds = kinds_of(study);
  const auto list = [&](const ExperimentRecord& record, std::vector<const ExperimentRecord*>& listed) {
    if (!campaign.streamed)
      listed.push_back(&record);
    else if (listed.size() < most)
      listed.push_back(&parts.first.emplace_back(record));
  };
  records_of(campaign).each([&](const ExperimentRecord& record) {
    parts.fallbacks += record.solver.fallbacks;
    for (KindCount& kind : parts.kinds)
      kind.experiments += record.draw.kind == kind.kind ? 1 : 0;
    if (s0_curves)
      s0_curves->add(record);
    if (record.status == ExperimentStatus::failed) {
      parts.failures.push_back({record.draw.index, record.message});
      list(record, parts.failed);
    }
    const AssessmentRecord* const chain = record.diagnosed();
    if (chain != nullptr && judge(study, record, *chain).wrong()) {
      parts.wrong_verdicts.push_back(record.draw.index);
      list(record, parts.wrong);
    }
  });
  if (s0_curves)
    parts.s0_curves = s0_curves->result();
  return parts;
}

}  // namespace mpm
