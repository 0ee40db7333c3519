#pragma once

#include <Eigen/Core>

#include "solvers/qp.hpp"

namespace mpm {

/// How much the multipliers y prove the hard limits to be violated: every x with lower <= x <= upper violates
/// some hard limit by at least
///
///     [ min over the box of (A'y)'x - sum_{y_i > 0} y_i hard_upper_i - sum_{y_i < 0} y_i hard_lower_i ]
///     / sum_i |y_i|,
///
/// because a weighted mean of the violations is no smaller (the lemma of Farkas). Positive: the problem has
/// no feasible point. Minus infinity when y proves nothing.
///
/// A coefficient of A'y below 1e-12 of the sum of the magnitudes in it counts as zero where x has no limit.
/// `scratch` (n) is overwritten; nothing is allocated.
double proven_violation(const QpStructure& structure, const QpData& data, const Eigen::VectorXd& y,
                        Eigen::VectorXd& scratch);

}  // namespace mpm
