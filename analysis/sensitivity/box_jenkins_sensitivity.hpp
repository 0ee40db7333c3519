#pragma once

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"

namespace mpm {

/// Returns the moves of the reference in the record from which T0 is identified, N values: deviations in CV
/// units that start at 0, each held for a random time between a twelfth and a half of
/// `study.sensitivity.samples`.
///
/// A setpoint goes to random levels within +-step_size. A soft limit moves in one direction only, by steps of
/// up to half of step_size, because the controller responds differently to the two directions
/// (docs/methods.md, T0). It moves into the range or, if `into_range` is false, out of it.
Eigen::RowVectorXd identification_moves(const Study& study, const ActiveConstraint& reference,
                                        bool into_range);

/// Identifies T0 as Box-Jenkins models, one for each CV and reference, from simulations in which one
/// reference at a time moves (appendix A3, (A3.1), (A3.2)). Returns their step responses in the layout of
/// `nominal_sensitivity`. The record has four times `study.sensitivity.samples`, at least 600.
///
/// Orders: B has 8 coefficients, F has 4 to 6, around the fifth order of section 4.3.2, C and D have 1. The
/// delay is 1 or that at which the CV begins to move. The choice is by %Fit (3.32) on the last 30 % of the
/// record.
///
/// If `step_direction` is mean, the models of the two directions are averaged.
/// @throws InputError as nominal_sensitivity(), and if a CV has no usable model
NominalSensitivity box_jenkins_sensitivity(const Study& study, const OperatingPoint& point,
                                           const QpSolverFactory& factory, const StepObserver& observer = {});

/// Returns the largest |a - b| over CVs and samples for each reference. Both must have the same shape.
Eigen::VectorXd largest_differences(const NominalSensitivity& a, const NominalSensitivity& b);

}  // namespace mpm
