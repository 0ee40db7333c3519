#pragma once

#include <Eigen/Core>

#include "solvers/qp.hpp"

namespace mpm {

/// Returns how much the multipliers y prove the hard limits to be violated: every x with lower <= x <= upper
/// violates some hard limit by at least
///
///     [ min over the box of (A'y)'x - sum_{y_i > 0} y_i hard_upper_i - sum_{y_i < 0} y_i hard_lower_i ]
///     / sum_i |y_i|,
///
/// because the mean of the violations with the weights |y_i| is no smaller than this (the lemma of Farkas).
/// If it is positive, the problem has no feasible point. Minus infinity if y proves nothing.
///
/// A coefficient of A'y where x has no limit counts as zero if it is below 1e-12 of the sum of the magnitudes
/// of its terms. `scratch` (n) is overwritten; nothing is allocated.
double proven_violation(const QpStructure& structure, const QpData& data, const Eigen::VectorXd& y,
                        Eigen::VectorXd& scratch);

}  // namespace mpm
