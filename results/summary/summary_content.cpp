#include "results/summary/summary_content.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/methods/chain_numbers.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {

std::vector<KindCount> kind_counts(const Campaign& campaign) {
  std::vector<KindCount> counts;
  if (campaign.study.names_scenarios())
    return counts;
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud,
                                    ExperimentKind::healthy, ExperimentKind::tuning, ExperimentKind::other})
    if (campaign.study.experiments.of(kind) > 0)
      counts.push_back(
          {kind, std::count_if(campaign.records.begin(), campaign.records.end(),
                               [kind](const auto& record) { return record.draw.kind == kind; })});
  return counts;
}

std::string kinds_text(const Campaign& campaign) {
  std::string text = campaign.study.names_scenarios() ? "named scenarios" : "";
  for (const KindCount& count : kind_counts(campaign))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.experiments, kind_name(count.kind));
  return text;
}

SummaryContent summary_content(const Campaign& campaign, const StudyFindings& findings) {
  SummaryContent parts(findings);
  if (!campaign.study.s0_perturbation.multipliers.empty()) {
    parts.s0_curves = s0_curves(campaign.study, campaign.records);
    parts.s0_fits = diagonal_fits(campaign.basis.sensitivity, campaign.study.controller.sample_time);
    parts.structure_fits = structure_fits(campaign.study, campaign.basis);
  }
  parts.audit = summarise(campaign.audit);
  for (const ExperimentRecord& record : campaign.records) {
    parts.fallbacks += record.solver.fallbacks;
    if (record.status == ExperimentStatus::failed)
      parts.failed.push_back(&record);
    const AssessmentRecord* const chain = record.by(kChainMethod);
    if (chain != nullptr && judge(campaign.study, record, *chain).wrong())
      parts.wrong.push_back(&record);
  }
  return parts;
}

}  // namespace mpm
