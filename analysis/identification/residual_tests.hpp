#pragma once

#include <limits>

#include <Eigen/Core>

namespace mpm {

/// A test statistic that follows a chi-square distribution when the hypothesis holds.
struct ChiSquareTest {
  double statistic = std::numeric_limits<double>::quiet_NaN();
  Eigen::Index degrees_of_freedom = 0;
  /// Probability of a statistic as large or larger when the hypothesis holds; NaN without a statistic.
  double p_value = std::numeric_limits<double>::quiet_NaN();
};

/// Whiteness of the residuals of a model by Ljung and Box (1978),
///
///   Q = N (N + 2) sum_{l=1}^{L} r_l^2 / (N - l),    Q ~ chi^2(L - p)
///
/// with the autocorrelations r_l of the residuals about 0, and p the number of fitted coefficients of the
/// noise model (na of an ARX model, nc + nd of a Box-Jenkins model, 0 of an output-error model): each takes
/// about one degree of freedom. L should be well above p, and small against N.
///
/// Residuals without variance give NaN.
/// @throws InputError for fewer than 2 residuals, values that are not finite, unless 0 <= fitted < lags < N
ChiSquareTest ljung_box_test(const Eigen::Ref<const Eigen::VectorXd>& residuals, Eigen::Index lags,
                             Eigen::Index fitted = 0);

/// Correlation of residuals with an input at each lag, with a test of all lags that a model must explain.
struct InputCorrelation {
  /// Entry max_lag + l is r_eu(l), l = -max_lag ... max_lag.
  Eigen::VectorXd values;
  /// Half width of the band in which a single value lies with the given confidence when residuals and input
  /// are independent.
  double band = 0.0;
  /// Of lags 0 ... max_lag together.
  ChiSquareTest test;
};

/// Correlation between residuals e and an input u,
///
///   r_eu(l) = sum_k e(k) u(k-l) / sqrt(sum e^2 sum u^2)
///
/// about 0 for e and about its mean for u. At l >= 0 it shows an effect of the input that the model lacks
/// (a delay that is too long, too low an order), at l < 0 feedback from the output to the input.
///
/// When e and u are independent, sqrt(N) r_eu(l) is asymptotically normal with variance
/// P = sum_m r_ee(m) r_uu(m) (Ljung 1999, eq. 16.66), and neighbouring lags are correlated. The band is
/// z sqrt(P/N). The test is xi = N r' R^-1 r ~ chi^2(max_lag + 1), R(i, j) = sum_m r_ee(m) r_uu(m + i - j).
/// The sums run over |m| <= 2 sqrt(N), with the weights of Bartlett's window, which keep P positive.
///
/// An input or residuals without variance give NaN.
/// @throws InputError for fewer than 2 samples, different lengths, values that are not finite, a max_lag
///   outside 0 ... N/4, or a confidence outside (0, 1)
InputCorrelation input_correlation(const Eigen::Ref<const Eigen::VectorXd>& residuals,
                                   const Eigen::Ref<const Eigen::VectorXd>& input, Eigen::Index max_lag,
                                   double confidence = 0.95);

}  // namespace mpm
