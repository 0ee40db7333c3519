#pragma once

#include <Eigen/Core>

#include "base/non_finite.hpp"

namespace mpm {

/// The correlation of the residual of a prediction error with the residual of an MV, at the lags at which the
/// MV can have an effect.
///
/// | member     | shape                 | meaning                                                          |
/// |------------|-----------------------|------------------------------------------------------------------|
/// | values     | max_lag - min_lag + 1 | r(l), correlation of eps2(k) with eps1(k-l)                      |
/// | band       |                       | half width that a single r(l) of independent signals keeps to    |
/// | white_band |                       | the same for white signals, z/sqrt(N - p)                        |
/// | lag, peak  |                       | where |r| is largest, and r there                                |
struct PartialCorrelation {
  Eigen::VectorXd values;
  double band = kNaN;
  double white_band = kNaN;
  Eigen::Index lag = 0;
  double peak = kNaN;

  /// Is |peak| outside the band and above `weakest`? False if there is no correlation.
  bool is_strong(double weakest = 0.0) const;
};

/// The partial correlation of an MV with a prediction error from the residuals of (2.5) and (2.6),
///
///   r(l) = sum_k eps2(k) eps1(k-l) / sqrt(sum eps1^2 sum eps2^2),   l = min_lag ... max_lag
///
/// about the mean for eps1 and about 0 for eps2.
/// The effect of a mismatch comes with dead time and lag, so it shows at many l. At l < 0 there is only
/// feedback, and also at l = 0 if u(k) acts after y(k). Both residuals are coloured: a mismatch acts through
/// a slow process, and an MV moves with setpoints. Their correlations then scatter more than those of white
/// signals, by Bartlett's formula for independent series (Box and Jenkins 1976, section 11.1.3; Ljung 1999,
/// eq. 16.66),
///
///   var r(l) = sum_m r_11(m) r_22(m) / (N - p)
///
/// and the band is z times its root; the white-noise band z/sqrt(N - p) would take most coloured residuals
/// for mismatches. The sum runs over |m| <= 2 sqrt(N), with the weights of Bartlett's window, which keep it
/// positive. p is the number of coefficients that the models of (2.5) and (2.6) each fitted to the same
/// samples: residuals from p regressors have N - p degrees of freedom.
///
/// Residuals without variance have no correlation: NaN, which is not strong.
/// @throws InputError for fewer than 2 samples, different lengths, values that are not finite, a confidence
///   outside (0, 1), and unless 0 <= min_lag <= max_lag <= N/4 and 0 <= parameters < N
PartialCorrelation partial_correlation(const Eigen::Ref<const Eigen::VectorXd>& eps1,
                                       const Eigen::Ref<const Eigen::VectorXd>& eps2, Eigen::Index min_lag,
                                       Eigen::Index max_lag, double confidence, Eigen::Index parameters = 0);

}  // namespace mpm
