#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The cost of one loop, with the weights of its own controller. All members are means over its samples.
///
/// | symbol | member    | size | equation                                                          |
/// |--------|-----------|------|-------------------------------------------------------------------|
/// | J      | cv        | ny   | Q_y (y - y_set)^2 + tau_y v^2 + c v, v the distance outside the   |
/// |        |           |      | soft limits and c the slack cost of the CV, if it has one         |
/// | v      | violation | ny   | mean distance outside the soft limits, in the unit of the CV      |
/// |        | effort    |      | sum over the MVs of Q_du (u(k) - u(k-1))^2                        |
/// |        | economics |      | phi_u u, the objective of the target optimizer (6.19)             |
struct LoopCost {
  Eigen::VectorXd cv, violation;
  double effort = 0.0, economics = 0.0;

  /// Returns the objective of the controller: the sum over the CVs plus the effort.
  double total() const { return cv.sum() + effort; }
};

/// Returns the cost of a loop of `study` over the samples that count; if `counted` is empty, all samples
/// count. The status of the loop must be ok.
LoopCost loop_cost(const Study& study, const Trajectory& loop, const std::vector<bool>& counted = {});

/// How to compute the cost of a CV that integrates and has both soft limits and a setpoint.
enum class LevelCost {
  as_others,  ///< from the distance to its setpoint, as for any CV with one
  in_range,   ///< from the distance outside its soft limits: a level may move freely within them
};

/// Returns whether the cost of a CV is that of the distance to its setpoint, not of the distance outside its
/// range.
bool costs_by_setpoint(const Study& study, Eigen::Index cv, LevelCost levels);

/// Returns the cost of each CV without the weights of the controller, ny. It is the mean over the samples
/// from `first` on, in the squared unit of the CV: of (y - y_set)^2 for a CV with a setpoint, and of the
/// squared distance outside its soft limits for any other CV. Samples at which the CV is off or missing (NaN)
/// do not count; NaN if no sample counts. Works for simulated loops and for records.
///
/// | symbol | name  | shape  | unit                              |
/// |--------|-------|--------|-----------------------------------|
/// | y      | y     | ny x N | of the CV                         |
/// | y_set  | y_set | ny x N | of the CV; empty if no CV has a setpoint |
Eigen::VectorXd cv_costs(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                         const Eigen::Ref<const Eigen::MatrixXd>& y_set, Eigen::Index first = 0,
                         LevelCost levels = LevelCost::as_others);

/// Returns what is added to both costs before they are compared, ny. For a CV without a setpoint, which costs
/// nothing within its limits, it is the variance of its noise. For a CV with a setpoint, whose cost contains
/// its noise, it is 0.
Eigen::VectorXd cost_floor(const Study& study, LevelCost levels = LevelCost::as_others);

/// Returns the costs of the CVs of a loop over the samples that count, for the comparison with another loop:
/// the sum of cv_costs() and cost_floor() with LevelCost::in_range, ny.
Eigen::VectorXd counted_costs(const Study& study, const Trajectory& loop, const std::vector<bool>& counted);

}  // namespace mpm
