#pragma once

#include <Eigen/Core>

#include "analysis/identification/signal_bank.hpp"

namespace mpm {

/// The coefficients of an output-error model y = sum_j q^-delay B_j/F_j u_j + e whose paths have equal
/// orders.
struct OutputErrorCoefficients {
  Eigen::MatrixXd B;  ///< nb x nu
  Eigen::MatrixXd F;  ///< nf + 1 x nu; the first row is 1
};

/// What a search looks at, and where it ends.
struct OutputErrorProblem {
  const SignalBank& u;       ///< inputs, their memory at least nb + nf + delay
  const Eigen::VectorXd& y;  ///< output
  Eigen::Index delay;
  int max_iterations;
  double largest_radius;  ///< of the roots of F
};

/// Whether all roots of every F lie within `radius`.
bool roots_within(const Eigen::MatrixXd& F, double radius);

/// Minimises sum e^2 from `start`, as `search_prediction_error` does: the same steps of the
/// Levenberg-Marquardt method (Ceres's scaling, radius and tolerances), to rounding. They are found from the
/// products J'J of the gradients, all of which follow from those of 1/F_j u_j and 1/F_j^2 B_j u_j by shifts
/// (`lagged_products`), in place of an orthogonal factorisation of J: a step costs about an eighth.
OutputErrorCoefficients search_output_error(const OutputErrorProblem& problem,
                                            const OutputErrorCoefficients& start);

/// Sum of e^2; infinity or NaN where it is not finite.
double output_error_loss(const OutputErrorProblem& problem, const OutputErrorCoefficients& model);

}  // namespace mpm
