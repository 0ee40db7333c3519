#pragma once

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "plants/linear/transfer_matrix.hpp"

namespace mpm {

/// The outputs that the loop would have had without modelling errors, and their parts.
///
/// | symbol  | member  | shape  | definition                                     |
/// |---------|---------|--------|------------------------------------------------|
/// | y_sim   | y_sim   | ny x N | G0 (u, d)                               (6.4)  |
/// | y0      | y0      | ny x N | y + S0 (y_sim - y)                      (6.5)  |
/// | y0_diag | y0_diag | ny x N | y + S0_diag (y_sim - y)                 (6.6)  |
struct NominalOutputs {
  Eigen::MatrixXd y_sim, y0, y0_diag;
};

/// Simulates the output of the nominal model under the recorded MVs `u` (nu x N) and MDs `d` (nd x N),
/// starting in the steady state of `initial_u` (nu) and zero disturbances.
Eigen::MatrixXd simulated_output(const TransferMatrix& model, double sample_time,
                                 const Eigen::Ref<const Eigen::VectorXd>& initial_u,
                                 const Eigen::Ref<const Eigen::MatrixXd>& u,
                                 const Eigen::Ref<const Eigen::MatrixXd>& d);

/// Returns y0_diag = y + S0_diag (y_sim - y) (6.6) of one CV, from the records y and y_sim (N samples each).
/// `step` is the unit step response of its diagonal element of T0 (values 1 ... L samples after the step, the
/// last one held). Throws InputError if the lengths of the records differ.
Eigen::RowVectorXd diagonal_nominal_output(const Eigen::Ref<const Eigen::RowVectorXd>& step,
                                           const Eigen::Ref<const Eigen::RowVectorXd>& y,
                                           const Eigen::Ref<const Eigen::RowVectorXd>& y_sim);

/// Returns y0 and y0_diag of the record y (ny x N) with the model output y_sim (ny x N). A CV inside its
/// range has S0_diag = 1, hence y0_diag = y_sim (6.17). Both are NaN if the sensitivity is not known. Throws
/// InputError if the shapes differ.
NominalOutputs nominal_outputs(const NominalSensitivity& sensitivity,
                               const Eigen::Ref<const Eigen::MatrixXd>& y,
                               const Eigen::Ref<const Eigen::MatrixXd>& y_sim);

}  // namespace mpm
