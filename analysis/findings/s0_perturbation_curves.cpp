#include "analysis/findings/s0_perturbation_curves.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/methods/chain_numbers.hpp"
#include "analysis/statistics/quantile.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

using Member = Eigen::VectorXd PerturbedIvar::*;

bool is_looked_at(const Study& study, const ExperimentRecord& record) {
  const auto multipliers = static_cast<Eigen::Index>(study.s0_perturbation.multipliers.size());
  return multipliers > 0 && record.status == ExperimentStatus::ok &&
         record.perturbed.time_constant.size() == multipliers &&
         record.perturbed.damping.size() == multipliers && record.by(kChainMethod) != nullptr;
}

/// Ivar_diag(modified)/Ivar_diag(true), multiplier by multiplier.
Eigen::VectorXd ratios(const ExperimentRecord& record, Member member) {
  return record.perturbed.*member / record.by(kChainMethod)->number("ivar_diag", record.draw.true_cv());
}

std::vector<RatioSpread> spreads(const Study& study, const std::vector<const ExperimentRecord*>& records,
                                 Member member) {
  std::vector<RatioSpread> result;
  for (std::size_t m = 0; m < study.s0_perturbation.multipliers.size(); ++m) {
    std::vector<double> values;
    for (const ExperimentRecord* record : records) {
      const double ratio = ratios(*record, member)(static_cast<Eigen::Index>(m));
      if (std::isfinite(ratio))
        values.push_back(ratio);
    }
    std::sort(values.begin(), values.end());
    result.push_back(values.empty() ? RatioSpread{kNaN, kNaN, kNaN, kNaN, kNaN}
                                    : RatioSpread{values.front(), sorted_quantile(values, 0.25),
                                                  sorted_quantile(values, 0.5), sorted_quantile(values, 0.75),
                                                  values.back()});
  }
  return result;
}

S0Change change(const Study& study, const std::vector<const ExperimentRecord*>& records, Member member) {
  const S0PerturbationOptions& options = study.s0_perturbation;
  S0Change result;
  std::int64_t within = 0, judged = 0;
  for (const ExperimentRecord* record : records) {
    const Eigen::VectorXd all = ratios(*record, member);
    bool any = false, inside = true;
    for (std::size_t m = 0; m < options.multipliers.size(); ++m) {
      const double ratio = all(static_cast<Eigen::Index>(m));
      if (options.multipliers[m] < options.tolerance_lower ||
          options.multipliers[m] > options.tolerance_upper || !std::isfinite(ratio))
        continue;
      any = true;
      inside = inside && ratio >= study.diagnosis.impact_lower && ratio <= study.diagnosis.impact_upper;
      result.largest = std::fmax(result.largest, std::abs(ratio - 1.0));  // passes over the NaN at the start
    }
    judged += any ? 1 : 0;
    within += any && inside ? 1 : 0;
  }
  result.within_band = rate(within, judged, study.aggregate.confidence);
  return result;
}

std::vector<const ExperimentRecord*> looked_at(const Study& study,
                                               std::span<const ExperimentRecord> records) {
  std::vector<const ExperimentRecord*> chosen;
  for (const ExperimentRecord& record : records)
    if (is_looked_at(study, record))
      chosen.push_back(&record);
  return chosen;
}

}  // namespace

std::vector<S0Curve> s0_curves(const Study& study, std::span<const ExperimentRecord> records) {
  const std::vector<const ExperimentRecord*> all = looked_at(study, records);
  std::vector<S0Curve> curves;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    std::vector<const ExperimentRecord*> of_cv;
    for (const ExperimentRecord* record : all)
      if (record->draw.true_cv() == cv)
        of_cv.push_back(record);
    if (of_cv.empty())
      continue;
    curves.push_back(
        {cv, static_cast<std::int64_t>(of_cv.size()), spreads(study, of_cv, &PerturbedIvar::time_constant),
         spreads(study, of_cv, &PerturbedIvar::damping), change(study, of_cv, &PerturbedIvar::time_constant),
         change(study, of_cv, &PerturbedIvar::damping)});
  }
  return curves;
}

S0Changes s0_changes(const Study& study, std::span<const ExperimentRecord> records) {
  const std::vector<const ExperimentRecord*> all = looked_at(study, records);
  return {change(study, all, &PerturbedIvar::time_constant), change(study, all, &PerturbedIvar::damping)};
}

}  // namespace mpm
