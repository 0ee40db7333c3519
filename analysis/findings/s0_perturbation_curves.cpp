#include "analysis/findings/s0_perturbation_curves.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "analysis/statistics/quantile.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

bool is_looked_at(const Study& study, const ExperimentRecord& record) {
  const auto multipliers = static_cast<Eigen::Index>(study.s0_perturbation.multipliers.size());
  return multipliers > 0 && record.status == ExperimentStatus::ok && record.draw.true_cv() >= 0 &&
         record.perturbed.time_constant.size() == multipliers &&
         record.perturbed.damping.size() == multipliers && record.diagnosed() != nullptr;
}

/// Ivar_diag(modified)/Ivar_diag(true) of one experiment, multiplier by multiplier.
struct Ratios {
  Eigen::Index true_cv;
  Eigen::VectorXd time_constant, damping;
};

using RatiosMember = Eigen::VectorXd Ratios::*;

std::vector<RatioSpread> spreads(const Study& study, const std::vector<const Ratios*>& experiments,
                                 RatiosMember member) {
  std::vector<RatioSpread> result;
  for (std::size_t m = 0; m < study.s0_perturbation.multipliers.size(); ++m) {
    std::vector<double> values;
    for (const Ratios* experiment : experiments) {
      const double ratio = (experiment->*member)(static_cast<Eigen::Index>(m));
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

S0Change change(const Study& study, const std::vector<const Ratios*>& experiments, RatiosMember member) {
  const S0PerturbationOptions& options = study.s0_perturbation;
  S0Change result;
  std::int64_t within = 0, judged = 0;
  for (const Ratios* experiment : experiments) {
    const Eigen::VectorXd& all = experiment->*member;
    bool any = false, inside = true;
    for (std::size_t m = 0; m < options.multipliers.size(); ++m) {
      const double ratio = all(static_cast<Eigen::Index>(m));
      if (options.multipliers[m] < options.tolerance_lower ||
          options.multipliers[m] > options.tolerance_upper || !std::isfinite(ratio))
        continue;
      any = true;
      inside = inside && ratio >= study.diagnosis.impact_lower && ratio <= study.diagnosis.impact_upper;
      result.largest = std::fmax(result.largest, std::abs(ratio - 1.0));  // ignores the NaN at the start
    }
    judged += any ? 1 : 0;
    within += any && inside ? 1 : 0;
  }
  result.within_band = rate(within, judged, study.aggregate.confidence);
  return result;
}

/// The experiments for which is_looked_at() holds.
class PerturbedExperiments {
 public:
  explicit PerturbedExperiments(const Study& study) : study_(study) {}

  void add(const ExperimentRecord& record) {
    if (!is_looked_at(study_, record))
      return;
    const Eigen::Index true_cv = record.draw.true_cv();
    const double ivar_diag = record.diagnosed()->number("ivar_diag", true_cv);
    all_.push_back(
        {true_cv, record.perturbed.time_constant / ivar_diag, record.perturbed.damping / ivar_diag});
  }

 protected:
  /// Returns the experiments whose affected CV is `cv`; all experiments if `cv` is none.
  std::vector<const Ratios*> of(std::optional<Eigen::Index> cv) const {
    std::vector<const Ratios*> chosen;
    for (const Ratios& experiment : all_)
      if (!cv || experiment.true_cv == *cv)
        chosen.push_back(&experiment);
    return chosen;
  }

  const Study& study_;

 private:
  std::vector<Ratios> all_;
};

struct CurveCounts : PerturbedExperiments {
  using PerturbedExperiments::PerturbedExperiments;

  std::vector<S0Curve> result() const {
    std::vector<S0Curve> curves;
    for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv)
      if (const std::vector<const Ratios*> of_cv = of(cv); !of_cv.empty())
        curves.push_back({cv, std::ssize(of_cv), spreads(study_, of_cv, &Ratios::time_constant),
                          spreads(study_, of_cv, &Ratios::damping),
                          change(study_, of_cv, &Ratios::time_constant),
                          change(study_, of_cv, &Ratios::damping)});
    return curves;
  }
};

struct ChangeCounts : PerturbedExperiments {
  using PerturbedExperiments::PerturbedExperiments;

  S0Changes result() const {
    const std::vector<const Ratios*> all = of(std::nullopt);
    return {change(study_, all, &Ratios::time_constant), change(study_, all, &Ratios::damping)};
  }
};

}  // namespace

Collector<std::vector<S0Curve>> s0_curve_collector(const Study& study) {
  return collector_of(CurveCounts(study));
}

Collector<S0Changes> s0_change_collector(const Study& study) {
  return collector_of(ChangeCounts(study));
}

}  // namespace mpm
