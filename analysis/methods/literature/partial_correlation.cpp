#include "analysis/methods/literature/partial_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "analysis/statistics/autocorrelation.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

void require_arguments(const Signal& eps1, const Signal& eps2, Eigen::Index min_lag, Eigen::Index max_lag,
                       Eigen::Index parameters) {
  const Eigen::Index N = eps1.size();
  require_signal("residuals", eps2, 2);
  require_signal("input", eps1, 2);
  require_same_length("residuals", eps2, "input", eps1);
  if (parameters < 0 || parameters >= N)
    throw InputError("coefficients of a partial correlation", fmt::format("{}", parameters),
                     fmt::format("0 to {}", N - 1));
  if (min_lag < 0 || min_lag > max_lag)
    throw InputError("lags of a partial correlation", fmt::format("{} to {}", min_lag, max_lag),
                     "0 or more, in ascending order");
  if (max_lag > N / 4)
    throw InputError("largest lag", fmt::format("{}", max_lag), fmt::format("0 to {}", N / 4));
}

/// sum_m r_11(m) r_22(m) over the lags of both. The weights of Bartlett's window keep it positive.
double bartlett_sum(const Eigen::VectorXd& r_11, const Eigen::VectorXd& r_22) {
  const Eigen::Index window = r_11.size() - 1;
  double sum = 0.0;
  for (Eigen::Index m = -window; m <= window; ++m) {
    const double weight = 1.0 - static_cast<double>(std::abs(m)) / static_cast<double>(window + 1);
    sum += weight * r_22(std::abs(m)) * r_11(std::abs(m));
  }
  return sum;
}

}  // namespace

bool PartialCorrelation::is_strong(double weakest) const {
  return std::abs(peak) > std::max(band, weakest);  // false for NaN
}

PartialCorrelation partial_correlation(const Signal& eps1, const Signal& eps2, Eigen::Index min_lag,
                                       Eigen::Index max_lag, double confidence, Eigen::Index parameters) {
  require_arguments(eps1, eps2, min_lag, max_lag, parameters);
  const Eigen::Index N = eps1.size();
  const auto samples = static_cast<double>(N);
  const double z = two_sided_normal_quantile(confidence);
  const auto window = std::min<Eigen::Index>(std::lround(2.0 * std::sqrt(samples)), N - 1 - max_lag);
  const Eigen::VectorXd r_22 = autocorrelation(eps2, window, confidence, 0.0).values;
  const Eigen::VectorXd r_11 = autocorrelation(eps1, window, confidence).values;
  PartialCorrelation result;
  if (r_11.hasNaN() || r_22.hasNaN()) {
    result.values.setConstant(max_lag - min_lag + 1, kNaN);
    return result;
  }

  const Eigen::VectorXd x = eps1.array() - eps1.mean();
  result.values.resize(max_lag - min_lag + 1);
  for (Eigen::Index l = min_lag; l <= max_lag; ++l)
    result.values(l - min_lag) = eps2.tail(N - l).dot(x.head(N - l));
  result.values /= std::sqrt(eps2.squaredNorm() * x.squaredNorm());
  result.values.cwiseAbs().maxCoeff(&result.lag);
  result.peak = result.values(result.lag);
  result.lag += min_lag;

  const auto freedom = static_cast<double>(N - parameters);
  const double band = z * std::sqrt(std::max(0.0, bartlett_sum(r_11, r_22)) / samples);
  result.band = band * std::sqrt(samples / freedom);
  result.white_band = z / std::sqrt(freedom);
  return result;
}

}  // namespace mpm
