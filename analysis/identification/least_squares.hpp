#pragma once

#include <Eigen/Core>

namespace mpm {

/// The default tolerance: columns of unit norm that are this close to dependent count as dependent.
inline constexpr double kRankTolerance = 1e-10;

/// The answer to a linear least-squares problem.
struct LeastSquares {
  Eigen::VectorXd x;          ///< p; of several minimisers the one of least norm, in scaled columns
  Eigen::Index rank = 0;      ///< of the matrix with columns of unit norm
  Eigen::MatrixXd inverse;    ///< p x p, (A'A)^-1; empty when rank < p
  double residual_sum = 0.0;  ///< |A x - b|^2
};

/// Minimises |A x - b| by orthogonal transformations of [A b], never by normal equations, which would square
/// the condition number. The columns of A are scaled to unit norm first, so that the rank does not depend on
/// units. The rank is read off the p x p triangle: a direction counts if its diagonal element in a pivoted
/// factorisation is above `rank_tolerance` times the largest one. The cost is one unpivoted factorisation,
/// 2 n p^2 operations.
///
/// | symbol | meaning         | shape |
/// |--------|-----------------|-------|
/// | A      | regressors      | n x p |
/// | b      | right-hand side | n     |
///
/// @throws InputError when n < p, p is 0, the lengths differ or the tolerance is outside (0, 1)
LeastSquares least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                           const Eigen::Ref<const Eigen::VectorXd>& b,
                           double rank_tolerance = kRankTolerance);

}  // namespace mpm
