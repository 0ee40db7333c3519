#pragma once

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"
#include "analysis/identification/prediction_error_options.hpp"

namespace mpm {

/// Minimises sum e^2 over the free coefficients, from `start`, by the Levenberg-Marquardt method of Ceres
/// with the gradients of `prediction_error_gradient`, on one thread. Steps to a root of C, D or F outside of
/// `options.largest_radius` are refused. Data, start and options must have been checked. The caller must
/// check whether the search ended at a minimum.
PolynomialModel search_prediction_error(const PolynomialModel& start,
                                        const Eigen::Ref<const Eigen::VectorXd>& y,
                                        const Eigen::Ref<const Eigen::MatrixXd>& u,
                                        const PredictionErrorOptions& options);

/// The power of two nearest to the root mean square of a signal, 1 for a signal that is 0: a unit in which
/// its size is about 1, and to which it is scaled without rounding.
double unit_of(const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Largest magnitude of the roots of C, D and every F.
double search_radius(const PolynomialModel& model);

}  // namespace mpm
