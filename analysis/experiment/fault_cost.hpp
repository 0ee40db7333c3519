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
/// | loss           | ny   | E J with it less E J without it                                      |
/// | violation      | ny   | E v with it less E v without it, in the unit of the CV               |
/// | loss_ratio     |      | E of LoopCost::total() with it over that without it                  |
/// | error          |      | standard error of loss_ratio: delta method over the pairs of loops   |
/// | effort, economics |   | differences, as loss                                                 |
/// | cost_ratio     | ny   | E of cv_costs() with it over that without it, each with cost_floor(), from the
/// onset on | | cost_ratio_error | ny | its standard error, as `error` |
struct FaultCost {
  Eigen::VectorXd variance_ratio, loss, violation;
  double loss_ratio = 1.0, error = 0.0, effort = 0.0, economics = 0.0;
  Eigen::VectorXd cost_ratio = {}, cost_ratio_error = {};

  /// Is the model worse than it was: does the cost of the loop, or a variance or the cost of a CV, whichever
  /// is the measure, rise above `upper` times itself?
  bool has_impact(double upper, ImpactMeasure measure = ImpactMeasure::variance) const;
};

/// The costs, LoopCost::total(), of the pilot loops of an experiment, loop by loop.
struct PilotCosts {
  std::vector<double> with, without;  ///< its faults
};

/// The index of the noise of pilot loop `loop` of `loops` of the experiment: none twice in a study, and the
/// same for all numbers that are expectations over pilot loops of an experiment.
std::int64_t pilot_noise(const Study& study, const ExperimentDraw& draw, int loops, int loop);

/// The cost of the faults of `draw` from `pairs` pairs of loops with noise of their own; without a fault, and
/// of a loop that does not run to its end, one of nothing (ratios of 1) and NaN. In both cases the costs of
/// the loops, which go into `costs` if it is given, are empty.
FaultCost fault_cost(const Study& study, const ExperimentDraw& draw, int pairs,
                     const QpSolverFactory& factory, SolverStatistics& pilots, PilotCosts* costs = nullptr);

}  // namespace mpm
