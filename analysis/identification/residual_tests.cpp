#include "analysis/identification/residual_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "analysis/statistics/autocorrelation.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ChiSquareTest chi_square_test(double statistic, Eigen::Index degrees_of_freedom) {
  if (!std::isfinite(statistic))
    return {kNan, degrees_of_freedom, kNan};
  const boost::math::chi_squared distribution(static_cast<double>(degrees_of_freedom));
  return {statistic, degrees_of_freedom,
          boost::math::cdf(boost::math::complement(distribution, std::max(0.0, statistic)))};
}

/// sum_m r_ee(m) r_uu(m + shift) over |m| <= the window's length, with Bartlett's weights on r_ee.
double convolution(const Eigen::VectorXd& r_ee, const Eigen::VectorXd& r_uu, Eigen::Index shift,
                   Eigen::Index window) {
  double sum = 0.0;
  for (Eigen::Index m = -window; m <= window; ++m) {
    const double weight = 1.0 - static_cast<double>(std::abs(m)) / static_cast<double>(window + 1);
    sum += weight * r_ee(std::abs(m)) * r_uu(std::abs(m + shift));
  }
  return sum;
}

/// sum_k e(k) x(k-l) for l = -max_lag ... max_lag.
Eigen::VectorXd cross_sums(const Eigen::VectorXd& e, const Eigen::VectorXd& x, Eigen::Index max_lag) {
  const Eigen::Index N = e.size();
  Eigen::VectorXd sums(2 * max_lag + 1);
  for (Eigen::Index l = 0; l <= max_lag; ++l) {
    sums(max_lag + l) = e.tail(N - l).dot(x.head(N - l));
    sums(max_lag - l) = e.head(N - l).dot(x.tail(N - l));
  }
  return sums;
}

}  // namespace

ChiSquareTest ljung_box_test(const Eigen::Ref<const Eigen::VectorXd>& residuals, Eigen::Index lags,
                             Eigen::Index fitted) {
  require_signal("residuals", residuals, 2);
  const Eigen::Index N = residuals.size();
  if (fitted < 0 || lags <= fitted || lags >= N)
    throw InputError("lags and fitted coefficients of a Ljung-Box test",
                     fmt::format("{} and {}", lags, fitted), fmt::format("0 <= fitted < lags < {}", N));
  const Eigen::VectorXd r = autocorrelation(residuals, lags, 0.95, 0.0).values;
  double sum = 0.0;
  for (Eigen::Index l = 1; l <= lags; ++l)
    sum += r(l) * r(l) / static_cast<double>(N - l);
  return chi_square_test(static_cast<double>(N) * static_cast<double>(N + 2) * sum, lags - fitted);
}

InputCorrelation input_correlation(const Eigen::Ref<const Eigen::VectorXd>& residuals,
                                   const Eigen::Ref<const Eigen::VectorXd>& input, Eigen::Index max_lag,
                                   double confidence) {
  require_signal("residuals", residuals, 2);
  require_signal("input", input, 2);
  require_same_length("residuals", residuals, "input", input);
  const Eigen::Index N = residuals.size();
  if (max_lag < 0 || max_lag > N / 4)
    throw InputError("largest lag", fmt::format("{}", max_lag), fmt::format("0 to {}", N / 4));
  const double z = two_sided_normal_quantile(confidence);

  const auto window =
      std::min<Eigen::Index>(std::lround(2.0 * std::sqrt(static_cast<double>(N))), N - 1 - max_lag);
  const Eigen::VectorXd r_ee = autocorrelation(residuals, window, confidence, 0.0).values;
  const Eigen::VectorXd r_uu = autocorrelation(input, window + max_lag, confidence).values;
  InputCorrelation result;
  if (r_ee.hasNaN() || r_uu.hasNaN()) {
    result.values.setConstant(2 * max_lag + 1, kNan);
    result.band = kNan;
    result.test = chi_square_test(kNan, max_lag + 1);
    return result;
  }
  const Eigen::VectorXd x = input.array() - input.mean();
  result.values = cross_sums(residuals, x, max_lag) / std::sqrt(residuals.squaredNorm() * x.squaredNorm());
  const auto samples = static_cast<double>(N);
  Eigen::MatrixXd R(max_lag + 1, max_lag + 1);
  for (Eigen::Index i = 0; i <= max_lag; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      R(i, j) = R(j, i) = convolution(r_ee, r_uu, i - j, window);
  result.band = z * std::sqrt(std::max(0.0, R(0, 0)) / samples);
  const Eigen::VectorXd r = result.values.tail(max_lag + 1);
  const Eigen::LDLT<Eigen::MatrixXd> factor(R);
  const bool positive = factor.info() == Eigen::Success && factor.isPositive();
  result.test = chi_square_test(positive ? samples * r.dot(factor.solve(r)) : kNan, max_lag + 1);
  return result;
}

}  // namespace mpm
