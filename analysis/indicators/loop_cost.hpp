#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The cost of one loop in the weights of its own controller; means over its samples.
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

  /// The objective of the controller: the sum over the CVs, and the effort.
  double total() const { return cv.sum() + effort; }
};

/// The cost of a loop of `study`, whose status must be ok, over the samples that count; empty: all of them.
LoopCost loop_cost(const Study& study, const Trajectory& loop, const std::vector<bool>& counted = {});

/// The cost of a CV that integrates and has soft limits as well as a setpoint.
enum class LevelCost {
  as_others,  ///< the distance to its setpoint, as any CV with one
  in_range,   ///< that outside of its soft limits: within them a level is there to wander
};

/// Does the CV cost the distance to a setpoint, and not that outside of its range?
bool costs_by_setpoint(const Study& study, Eigen::Index cv, LevelCost levels);

/// The cost of each CV in its controller, without weights, ny: the mean over the samples from `first`
/// on of (y - y_set)^2 for a CV with a setpoint, and of the squared distance outside of its soft limits for
/// any other, in the unit of the CV squared. Samples at which the CV is off or missing (NaN) do not count;
/// NaN without any. For simulated loops and for records.
///
/// | symbol | name  | shape  | unit                              |
/// |--------|-------|--------|-----------------------------------|
/// | y      | y     | ny x N | of the CV                         |
/// | y_set  | y_set | ny x N | empty where no CV has a setpoint  |
Eigen::VectorXd cv_costs(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                         const Eigen::Ref<const Eigen::MatrixXd>& y_set, Eigen::Index first = 0,
                         LevelCost levels = LevelCost::as_others);

/// What is added to both costs before they are compared, ny: of a CV without a setpoint, which costs nothing
/// within its limits, the variance of its noise; of one with a setpoint, which has its noise in its cost, 0.
Eigen::VectorXd cost_floor(const Study& study, LevelCost levels = LevelCost::as_others);

/// What the CVs of a loop cost over the samples that count, to be compared with another loop: cv_costs() and
/// cost_floor() with levels in their range, ny.
Eigen::VectorXd counted_costs(const Study& study, const Trajectory& loop, const std::vector<bool>& counted);

}  // namespace mpm
