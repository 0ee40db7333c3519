#include "analysis/methods/literature/variance_ratio_limits.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/autocorrelation.hpp"
#include "analysis/statistics/largest_root.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

void require_variances(double mu, const VarianceSample& benchmark, const VarianceSample& monitored) {
  if (!(mu >= 0.0))
    throw InputError("ratio of variances", fmt::format("{}", mu), "0 or more");
  for (const VarianceSample& sample : {benchmark, monitored})
    if (sample.samples < 2)
      throw InputError("samples of a variance", fmt::format("{}", sample.samples), "2 or more");
}

}  // namespace

double autocorrelation_factor(const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index largest_lag) {
  require_signal("signal of an autocorrelation factor", signal, 2);
  if (largest_lag < 0)
    throw InputError("largest lag", fmt::format("{}", largest_lag), "0 (all lags) or more");
  const Eigen::Index n = signal.size();
  const Eigen::Index lags = largest_lag == 0 ? n - 1 : std::min(largest_lag, n - 1);
  const Eigen::VectorXd r = autocorrelation(signal, lags).values;
  if (std::isnan(r(0)))
    return 1.0;
  const Eigen::ArrayXd weight =
      1.0 - Eigen::ArrayXd::LinSpaced(lags, 1.0, static_cast<double>(lags)) / static_cast<double>(n);
  return 1.0 + 2.0 * (weight * r.tail(lags).array().square()).sum();
}

Interval variance_ratio_limits(double mu, const VarianceSample& benchmark, const VarianceSample& monitored,
                               double confidence) {
  require_variances(mu, benchmark, monitored);
  const auto variance = [](const VarianceSample& sample) {
    return sample.autocorrelation_factor / static_cast<double>(sample.samples - 1);
  };
  const double half_width =
      two_sided_normal_quantile(confidence) * std::sqrt(2.0 * (variance(benchmark) + variance(monitored)));
  const double upper = half_width < 1.0 ? mu / (1.0 - half_width) : kInfinity;
  return {mu / (1.0 + half_width), upper};
}

Interval largest_root_limits(double mu, const VarianceSample& benchmark, const VarianceSample& monitored,
                             double confidence, Eigen::Index variables) {
  require_confidence(confidence);
  require_variances(mu, benchmark, monitored);
  const auto freedom = [](const VarianceSample& sample) {
    return static_cast<double>(sample.samples - 1) / sample.autocorrelation_factor;
  };
  const double probability = 0.5 * (1.0 - confidence);
  const double upper =
      largest_root_upper_quantile(probability, variables, freedom(benchmark), freedom(monitored));
  return {mu / largest_root_upper_quantile(probability, variables, freedom(monitored), freedom(benchmark)),
          mu > 0.0 ? mu * upper : 0.0};
}

}  // namespace mpm
