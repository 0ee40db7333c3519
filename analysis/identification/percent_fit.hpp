#pragma once

#include <Eigen/Core>

namespace mpm {

/// The best-fit index of an estimate of a measured output (3.32),
///
///   %Fit = 100 (1 - |y - y_est| / |y - mean y|)
///
/// 100 for an estimate that is right, 0 for one as good as the mean, without a lower bound. An output without
/// variance (to rounding) has no such index: NaN.
///
/// | symbol   | meaning                     | shape | unit      |
/// |----------|-----------------------------|-------|-----------|
/// | y, y_est | measured, estimated output  | N     | of the CV |
///
/// @throws InputError for fewer than 2 samples, different lengths, or measurements that are not finite. An
///   estimate that is not finite, of an unstable model, gives -infinity.
double percent_fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                   const Eigen::Ref<const Eigen::VectorXd>& y_est);

}  // namespace mpm
