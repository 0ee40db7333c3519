#pragma once

#include <Eigen/Core>

namespace mpm {

/// Cosines of the angles between a subspace and the coordinate axes (2.12), (2.13):
///
///   cos theta_k = |P (P^T P)^-1 P^T ev_k|
///
/// | symbol      | name         | meaning                                        | shape  | unit |
/// |-------------|--------------|------------------------------------------------|--------|------|
/// | P           | `directions` | columns that span it, linearly independent     | ny x m | -    |
/// | cos theta_k | result       | 1 for an axis in it, 0 for one at right angles | ny     | -    |
///
/// 0 for every axis if there are no directions (m = 0).
/// @throws InputError for more directions than axes or values that are not finite
Eigen::VectorXd subspace_cosines(const Eigen::Ref<const Eigen::MatrixXd>& directions);

/// The cosine above which a CV belongs to a subspace that is estimated from samples, for a cutting angle of
/// 45 degrees (2.14):
///
///   beta = sqrt(1/2 + z / sqrt(2 n_g)),   n_g = sqrt(n_I n_II)
///
/// with z the two-sided normal quantile of `confidence`. For the shortest records (n_g below 8 at 0.95) beta
/// is above 1, which no cosine exceeds.
/// @throws InputError unless both lengths are 1 or more and 0 < confidence < 1
double subspace_cosine_limit(Eigen::Index samples_benchmark, Eigen::Index samples_monitored,
                             double confidence);

}  // namespace mpm
