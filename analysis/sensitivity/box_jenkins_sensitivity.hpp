#pragma once

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"

namespace mpm {

/// How the reference is moved in the record that T0 is identified from, N values: deviations in CV units,
/// from 0, each held for a random time between a twelfth and a half of `study.sensitivity.samples`.
///
/// A setpoint goes to random levels within +-step_size. A soft limit goes one way, by steps of up to half of
/// step_size, since the controller answers the two ways differently (docs/methods.md, T0): into the range or,
/// with `into_range` false, out of it.
Eigen::RowVectorXd identification_moves(const Study& study, const ActiveConstraint& reference,
                                        bool into_range);

/// T0 as Box-Jenkins models, one of each CV for each reference, each from a simulation in which that
/// reference alone moves (appendix A3, (A3.1), (A3.2)), and their step responses in the layout of
/// `nominal_sensitivity`. The record has four times `study.sensitivity.samples`, 600 at least.
///
/// Orders: B of 8, F of 4 to 6 coefficients around the fifth order of section 4.3.2, C and D of 1, the delay
/// 1 or that at which the CV begins to move; by %Fit (3.32) on the last 30 % of the record.
///
/// With `step_direction` mean the models of the two ways are averaged.
/// @throws InputError as nominal_sensitivity(), and when a CV has no usable model
NominalSensitivity box_jenkins_sensitivity(const Study& study, const OperatingPoint& point,
                                           const QpSolverFactory& factory, const StepObserver& observer = {});

/// Largest |a - b| over CVs and samples for each reference; both have the same shape.
Eigen::VectorXd largest_differences(const NominalSensitivity& a, const NominalSensitivity& b);

}  // namespace mpm
