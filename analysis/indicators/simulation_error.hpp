#pragma once

#include <Eigen/Core>

namespace mpm {

/// Returns how far the model is from the plant, for each CV:
///
///   SSE_i = sqrt(sum over k of (y_sim,i(k) - y_i(k))^2)   (4.17)
///
/// The total of a loop is TSSE = sum over i of SSE_i (6.21). Both grow with the square root of the length.
///
/// | symbol | name  | shape  | unit |
/// |--------|-------|--------|------|
/// | y      | y     | ny x N | CV   |
/// | y_sim  | y_sim | ny x N | CV   |
/// | SSE    | -     | ny     | CV   |
///
/// @throws InputError when the shapes differ
Eigen::VectorXd simulation_errors(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                  const Eigen::Ref<const Eigen::MatrixXd>& y_sim);

}  // namespace mpm
