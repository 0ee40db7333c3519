#include "analysis/statistics/autocorrelation.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Half widths z sqrt((1 + 2 sum_{j<l} r_j^2)/N) for the lags of `r`.
Eigen::VectorXd bartlett(const Eigen::VectorXd& r, double white_band) {
  Eigen::VectorXd band = Eigen::VectorXd::Zero(r.size());
  double sum = 0.0;
  for (Eigen::Index lag = 1; lag < r.size(); ++lag) {
    band[lag] = white_band * std::sqrt(1.0 + 2.0 * sum);
    sum += r[lag] * r[lag];
  }
  return band;
}

}  // namespace

Autocorrelation autocorrelation(const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index max_lag,
                                double confidence, std::optional<double> centre) {
  require_signal("signal of an autocorrelation", signal, 2);
  const Eigen::Index n = signal.size();
  if (max_lag < 0 || max_lag >= n) {
    throw InputError("largest lag", fmt::format("{}", max_lag), fmt::format("0 to {}", n - 1));
  }
  if (centre && !std::isfinite(*centre)) {
    throw InputError("centre of an autocorrelation", fmt::format("{}", *centre), "a finite number");
  }
  const double z = two_sided_normal_quantile(confidence);

  Autocorrelation result;
  result.white_band = z / std::sqrt(static_cast<double>(n));
  const Eigen::VectorXd deviation = signal.array() - centre.value_or(signal.mean());
  const double power = deviation.squaredNorm();
  const bool still = !centre && stands_still(signal);
  if (still || power <= static_cast<double>(n) * variance_floor(signal)) {
    result.values = Eigen::VectorXd::Constant(max_lag + 1, kNaN);
    result.bartlett_band = result.values;
    return result;
  }
  result.values.resize(max_lag + 1);
  for (Eigen::Index lag = 0; lag <= max_lag; ++lag) {
    result.values[lag] = deviation.tail(n - lag).dot(deviation.head(n - lag)) / power;
  }
  result.bartlett_band = bartlett(result.values, result.white_band);
  return result;
}

}  // namespace mpm
