#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

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

/// What a fault costs: the loop with it against the same loop without it (same world, excitation and noise),
/// in expectation over noise and background. Signs are kept: a fault by which a variance falls is no loss.
///
/// | member         | size | meaning                                                              |
/// |----------------|------|----------------------------------------------------------------------|
/// | variance_ratio | ny   | E var y with the fault over E var y without it                       |
/// | loss           | ny   | E J with it less E J without it                                      |
/// | violation      | ny   | E v with it less E v without it, in the unit of the CV               |
/// | loss_ratio     |      | E of LoopCost::total() with it over that without it                  |
/// | error          |      | standard error of loss_ratio: delta method over the pairs of loops   |
/// | effort, economics |   | differences, as loss                                                 |
struct FaultCost {
  Eigen::VectorXd variance_ratio, loss, violation;
  double loss_ratio = 1.0, error = 0.0, effort = 0.0, economics = 0.0;

  /// Is the model worse than it was: does a variance or the cost of the loop rise above `upper` times itself?
  bool has_impact(double upper) const;
};

/// The index of the noise of pilot loop `loop` of `loops` of the experiment: none twice in a study, and the
/// same for all numbers that are expectations over pilot loops of an experiment.
std::int64_t pilot_noise(const Study& study, const ExperimentDraw& draw, int loops, int loop);

/// The cost of the faults of `draw` from `pairs` pairs of loops with noise of their own; without a fault, and
/// of a loop that does not run to its end, one of nothing (ratios of 1) and NaN.
FaultCost fault_cost(const Study& study, const ExperimentDraw& draw, int pairs,
                     const QpSolverFactory& factory, SolverStatistics& pilots);

}  // namespace mpm
