#pragma once

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"

namespace mpm {

/// The gradient of the prediction errors with respect to the free coefficients, N x p in the order of
/// `PolynomialModel::parameters`, by the sensitivity filters (Ljung 1999, section 10.3). With
/// w_j = q^-delay B_j/F_j u_j and v = A y - sum_j w_j, e = (D/C) v:
///
///   de/da_i =  (D/C) q^-i y                    de/dc_i = -(1/C) q^-i e
///   de/db_ji = -(D/(C F_j)) q^-(delay+i) u_j   de/dd_i =  (1/C) q^-i v
///   de/df_ji =  (D/(C F_j)) q^-i w_j
///
/// so that each polynomial costs one filtered signal, which is then shifted.
/// @throws InputError as `prediction_errors`
Eigen::MatrixXd prediction_error_gradient(const PolynomialModel& model,
                                          const Eigen::Ref<const Eigen::VectorXd>& y,
                                          const Eigen::Ref<const Eigen::MatrixXd>& u,
                                          StartState start = StartState::rest);

}  // namespace mpm
