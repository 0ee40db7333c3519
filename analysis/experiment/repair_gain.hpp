#pragma once

#include <optional>

#include <Eigen/Core>

#include "analysis/experiment/fault_cost.hpp"
#include "analysis/methods/assessment.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The gain of repairing each channel of the model, by simulation: the truth for methods that name a channel.
/// With J = LoopCost::total() of the loop of an experiment, whose fault is there from the first sample on,
///
///     gain(i, j) = (E J - E J(i, j)) / E J_0
///
/// J is that of the loop as it is, J(i, j) that of the same loop under the controller whose model has the
/// true channel from input j to CV i (loop_with_model()), J_0 that of the same loop without the fault. The
/// inputs are the MVs, and behind them the MDs. The expectation is over noise and background; loops with the
/// same noise are compared with each other. 0.3 means that the repair saves 30 % of the cost of the loop
/// without the fault. A repair with a gain below 0 does harm.
///
/// | member | shape          | meaning                                                                    |
/// |--------|----------------|----------------------------------------------------------------------------|
/// | gain   | ny x (nu + nd) | 0: plant and model agree; NaN: the repaired loop does not run to its end   |
/// | error  | ny x (nu + nd) | its standard error (ratio_of_means()); NaN for a single loop               |
///
/// If nothing was computed, both are empty, or NaN when read from an archive. With WorldRanges::repair_screen
/// s, the channels whose gain in the first loop is below s times the largest gain have that loop only.
struct RepairGains {
  Eigen::MatrixXd gain, error;

  /// The gain of the best repair; none if no gain is positive beyond chance, that is, above twice its error.
  std::optional<double> best() const;
  /// The gain of repairing this channel as a share of best(), from 0 to 1; 0 for no channel. There must be a
  /// best repair.
  double share_of(const std::optional<Channel>& channel) const;
};

/// The gains of an experiment with mismatches of a linear plant, in expectation over `loops` loops with noise
/// of their own. Empty without a mismatch, for a nonlinear plant, for 0 loops, and if the loop as it is or
/// the loop without the fault does not run to its end. `known` are the costs that fault_cost() found for this
/// experiment of a study with worlds: its loops without the faults are those of J_0, and those with faults
/// from the first sample on are those of J, so that only loops with a repaired model are run.
RepairGains repair_gains(const Study& study, const ExperimentDraw& draw, int loops,
                         const QpSolverFactory& factory, SolverStatistics& pilots,
                         const PilotCosts& known = {});

}  // namespace mpm
