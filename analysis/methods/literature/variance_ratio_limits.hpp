#pragma once

#include <Eigen/Core>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// The factor by which the autocorrelation of a signal raises the variance of its sample variance, compared
/// with white noise (2.9), (A1.9), after Desborough and Harris (1992):
///
///   f = 1 + 2 sum_{j=1}^{L} (1 - j/n) r_j^2
///
/// | symbol | meaning                                                                  | shape | unit |
/// |--------|--------------------------------------------------------------------------|-------|------|
/// | n      | length of the signal                                                     | 1     | -    |
/// | L      | `largest_lag`; 0 or n and more: n - 1, all lags, as the thesis prints it | 1     | -    |
/// | r_j    | sample autocorrelation about the mean (`autocorrelation`)                | L     | -    |
///
/// The squares of sample autocorrelations do not average out. With all lags, f of white noise is about 5/3
/// instead of 1; with L lags, f is too large by a share of about 2L/n.
///
/// A signal that stands still has no autocorrelation: its f is 1.
/// @throws InputError for fewer than 2 samples, values that are not finite or a negative largest lag
double autocorrelation_factor(const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index largest_lag = 0);

/// A sample variance with the numbers behind its confidence limits.
struct VarianceSample {
  Eigen::Index samples = 0;
  double autocorrelation_factor = 1.0;  ///< f of (2.9)
};

/// Confidence limits of the ratio mu of the sample variance of `monitored` to that of `benchmark` (2.10),
/// (2.11):
///
///   mu/(1 + h) <= true ratio <= mu/(1 - h),   h = z sqrt(2 (f_I/(n_I - 1) + f_II/(n_II - 1)))
///
/// with z the two-sided normal quantile of `confidence`. If h >= 1, the records are too short to bound the
/// ratio from above: the upper limit is +infinity (the formula as printed would give a negative number).
/// @throws InputError unless mu >= 0, both samples have 2 values or more and 0 < confidence < 1
Interval variance_ratio_limits(double mu, const VarianceSample& benchmark, const VarianceSample& monitored,
                               double confidence);

/// Limits of the ratio mu that hold at the same time for every direction, that is, for every linear
/// combination of `variables` signals. So they also hold for a direction that the data choose (Roy 1953, the
/// union-intersection principle):
///
///   mu/l(nu_II, nu_I) <= true ratio <= mu l(nu_I, nu_II),   nu = (n - 1)/f
///
/// where l(b, a) is the value that the largest root of two covariance matrices with b and a degrees of
/// freedom exceeds with the probability (1 - confidence)/2 (`largest_root_upper_quantile`). nu is the number
/// of independent values whose sample variance scatters as much as that of the n values. If a record is too
/// short for its autocorrelation, so that nu_I or nu_II is not above the number of variables, the limit is 0
/// or +infinity.
/// @throws InputError as `variance_ratio_limits`, and for no variable
Interval largest_root_limits(double mu, const VarianceSample& benchmark, const VarianceSample& monitored,
                             double confidence, Eigen::Index variables);

}  // namespace mpm
