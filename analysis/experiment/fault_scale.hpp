#pragma once

#include <Eigen/Core>

#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

// Fault sizes that mean the same on every plant: set by their effect on the variance of the affected CVs.

namespace mpm {

/// Does the study ask for a given effect of the faults of this experiment?
bool has_asked_impact(const Study& study, const ExperimentDraw& draw);

/// The effect of the faults of an experiment is the largest change of the variance of an affected CV,
///
///   max |Ivar_basis,i - 1| over the affected CVs i,   Ivar_basis of (6.22),
///
/// infinite if the loop does not run to its end.
double effect(const Study& study, const ExperimentDraw& draw, const Trajectory& loop,
              const Eigen::MatrixXd& y_basis);

/// The scales at which the faults of `draw`, which has the scales 1, have the effect that the study draws for
/// them (`impact` of [mismatch], [disturbance] and [other]): found by pilot loops, with mismatch and
/// disturbance each alone. Pilot loops have the noise of the experiment, so an experiment with one fault has
/// exactly this effect. The effect need not grow with the scale, and some faults never reach it: a dead time
/// cannot become negative, a factor stays in [0.1, 10] or, for a parameter of a nonlinear plant, in its
/// range. Then the scale is that of the pilot loop whose effect is nearest. `y_basis` is the output of the
/// loop without the faults; `pilots` counts the work of the pilot loops.
FaultScales scales_for_impact(const Study& study, const ExperimentDraw& draw, const Eigen::MatrixXd& y_basis,
                              const QpSolverFactory& factory, SolverStatistics& pilots,
                              const StepObserver& observer = {});

}  // namespace mpm
