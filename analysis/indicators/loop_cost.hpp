#pragma once

#include <Eigen/Core>

#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// What one loop costs, in the weights of its own controller; means over its samples.
///
/// | symbol | member    | size | equation                                                          |
/// |--------|-----------|------|-------------------------------------------------------------------|
/// | J      | cv        | ny   | Q_y (y - y_set)^2 + tau_y v^2, v the distance outside the soft limits |
/// | v      | violation | ny   | mean distance outside the soft limits, in the unit of the CV      |
/// |        | effort    |      | sum over the MVs of Q_du (u(k) - u(k-1))^2                        |
/// |        | economics |      | phi_u u, the objective of the target optimizer (6.19)             |
struct LoopCost {
  Eigen::VectorXd cv, violation;
  double effort = 0.0, economics = 0.0;

  /// What the controller minimises: the sum over the CVs, and the effort.
  double total() const { return cv.sum() + effort; }
};

/// The cost of a loop of `study`, whose status must be ok.
LoopCost loop_cost(const Study& study, const Trajectory& loop);

}  // namespace mpm
