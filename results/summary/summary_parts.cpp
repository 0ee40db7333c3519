#include "results/summary/summary_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "analysis/findings/method_rates.hpp"
#include "analysis/findings/reference.hpp"

namespace mpm {

bool is_share(std::string_view name) {
  constexpr std::array<std::string_view, 5> kShares{"infeasible", "impactful", "located", "source_recognised",
                                                    "within_band"};
  for (const std::string_view share : {"infeasible_", "false_alarm_", "false_mpm_", "false_ud_"})
    if (name.starts_with(share))
      return true;
  const std::string_view last = name.substr(name.rfind('.') + 1);  // the whole name without a '.'
  for (const std::string_view share : kShares)
    if (last == share)
      return true;
  const std::span<const MethodRateInfo> rates = method_rate_infos();
  return std::any_of(rates.begin(), rates.end(),
                     [&](const MethodRateInfo& rate) { return last == rate.name; });
}

bool SummaryValue::has_reported() const {
  return !std::isnan(reported);
}

SummaryParts summary_parts(const Campaign& campaign) {
  SummaryParts parts;
  parts.aggregate = aggregate(campaign.study, campaign.records);
  for (AggregateValue& value : named_values(parts.aggregate)) {
    const double reported = reference_value(campaign.study, value.name);
    parts.values.push_back({std::move(value), reported});
  }
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
    if (record.wrong())
      parts.wrong.push_back(&record);
  }
  return parts;
}

}  // namespace mpm
