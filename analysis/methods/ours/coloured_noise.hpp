#pragma once

#include <Eigen/Core>

namespace mpm {

/// Order of the autoregression n(k) = sum_l a_l n(k - l) + w(k) that stands for the slow part of the errors
/// of a CV.
inline constexpr Eigen::Index kNoiseOrder = 3;

/// Fits a (`order` coefficients) to the signal r by least squares over its samples, which follow each other.
Eigen::VectorXd autoregression_of(const Eigen::VectorXd& r, Eigen::Index order = kNoiseOrder);

/// The columns of `signals` (N x m) less what a predicts of them; the first samples, whose past is not known,
/// are left out (N - a.size() x m).
Eigen::MatrixXd whitened_by(const Eigen::VectorXd& a, const Eigen::MatrixXd& signals);

}  // namespace mpm
