#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/indicators/loop_cost.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The cost of a fault: the loop with it compared with the same loop without it (same world, excitation and
/// noise), in expectation over noise and background. Signs are kept: a fault that lowers a variance is no
/// loss.
///
/// | member         | size | meaning                                                              |
/// |----------------|------|----------------------------------------------------------------------|
/// | variance_ratio | ny   | E var y with the fault over E var y without it                       |
/// | loss           | ny   | E J with it minus E J without it                                     |
/// | violation      | ny   | E v with it minus E v without it, in the unit of the CV              |
/// | loss_ratio     |      | E of LoopCost::total() with it over that without it                  |
/// | error          |      | standard error of loss_ratio: delta method over the pairs of loops   |
/// | effort, economics |   | differences, as for loss                                             |
/// | cost_ratio     | ny   | E of cv_costs() with it over that without it, from the onset on,     |
/// |                |      | each with cost_floor()                                               |
/// | cost_ratio_error | ny | standard error of cost_ratio, as `error`                             |
struct FaultCost {
  Eigen::VectorXd variance_ratio, loss, violation;
  double loss_ratio = 1.0, error = 0.0, effort = 0.0, economics = 0.0;
  Eigen::VectorXd cost_ratio = {}, cost_ratio_error = {};

  /// Does the fault have an impact? It has one if the cost of the loop, or the variance or the cost of a CV,
  /// whichever is the measure, is more than `upper` times its value without the fault.
  bool has_impact(double upper, ImpactMeasure measure = ImpactMeasure::variance) const;
};

/// The costs, LoopCost::total(), of the pilot loops of an experiment, loop by loop.
struct PilotCosts {
  std::vector<double> with, without;  ///< the faults of the experiment
};

/// The index of the noise of pilot loop `loop` of `loops` of the experiment. No index occurs twice in a
/// study. All expectations over pilot loops of an experiment use the same indices.
std::int64_t pilot_noise(const Study& study, const ExperimentDraw& draw, int loops, int loop);

/// The cost of the faults of `draw`, from `pairs` pairs of loops, each pair with its own noise. Without a
/// fault the cost is 0 (ratios of 1); if a loop does not run to its end, it is NaN. `costs`, if given, gets
/// the costs of the loops; in these two cases it is left as it is.
FaultCost fault_cost(const Study& study, const ExperimentDraw& draw, int pairs,
                     const QpSolverFactory& factory, SolverStatistics& pilots, PilotCosts* costs = nullptr);

}  // namespace mpm
