#pragma once

#include <Eigen/Core>

#include "analysis/identification/identification.hpp"

namespace mpm {

/// Standard errors of the step responses of an identified model, nu x samples in the layout of
/// `step_response`: the uncertainty of the coefficients P, carried over to first order,
///
///   var h(l) = g' P g,   g = dh(l)/dtheta
///
/// They hold for a model of the right orders; what a model that is too small gets wrong is not in them. NaN
/// where the identification has no covariance.
/// @throws InputError for an invalid model or fewer than 1 sample
Eigen::MatrixXd step_response_errors(const Identification& identification, Eigen::Index samples);

}  // namespace mpm
