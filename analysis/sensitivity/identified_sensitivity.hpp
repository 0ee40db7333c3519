#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/identification.hpp"
#include "analysis/identification/order_selection.hpp"

namespace mpm {

/// Options of `identified_sensitivity`.
struct IdentifiedSensitivityOptions {
  /// Samples of the step responses.
  Eigen::Index samples = 100;
  /// Orders to choose from for each CV: Box-Jenkins models whose paths all have the delay 1, since the
  /// controller answers at the sample at which the reference moves and the plant one sample later. Dead time
  /// is found by small leading coefficients of B, or by further delays in the grid.
  OrderGrid orders{{0}, {2, 3, 4}, {2, 3, 4}, {1}, {1}, {1}};
  /// Options of the choice of the order and of the search. `selection.fit.start` is the state before the
  /// record.
  OrderSelectionOptions selection;

  /// @throws InputError for fewer than 1 sample or invalid options of the selection
  void validate() const;
};

/// One CV's part of an identified T0.
struct IdentifiedRow {
  /// On the whole record, of the selected orders. Its model has one input a reference; for a CV that stands
  /// still (to rounding) no reference has an effect: the model is 0, and the status noise_free.
  Identification identification;
  /// %Fit (3.32) on the validation data, of the model from the estimation data alone. NaN for a CV at rest.
  double validation_fit = 0.0;
};

/// T0 from a record of a closed loop.
struct IdentifiedSensitivity {
  /// [reference] ny x samples; column l-1 holds the outputs l samples after a unit step in that reference:
  /// the layout of `NominalSensitivity::step_response`, a reference instead of an active limit. NaN in
  /// the row of a CV without a usable model.
  std::vector<Eigen::MatrixXd> step_response;
  std::vector<IdentifiedRow> rows;  ///< one a CV
};

/// T0 as a Box-Jenkins model with one output and all references as inputs for each CV, from a simulation of
/// the controller on its own model with excited references (appendix A3 of the thesis, (A3.1), (A3.2)):
///
///   y_i = sum_j T0_ij r_j + (C_i/D_i) e_i
///
/// | symbol | meaning                                                        | shape     | unit        |
/// |--------|----------------------------------------------------------------|-----------|-------------|
/// | r      | references (setpoints or active limits), deviations            | n_ref x N | of their CV |
/// | y      | outputs of the simulation, deviations; y(k) from r up to k - 1 | ny x N    | of the CV   |
///
/// The orders of each CV are those of the grid with the best criterion on the end of the record; the model is
/// then identified again on the whole of it; its end must therefore be excited as well. All references may
/// move at once when the loop is linear. A range MPC is not: move one limit at a time, in one direction
/// (docs/methods.md, Identification), with one call each.
/// @throws InputError for different lengths, values that are not finite, no reference, too short a record, or
///   invalid options
IdentifiedSensitivity identified_sensitivity(const Eigen::Ref<const Eigen::MatrixXd>& r,
                                             const Eigen::Ref<const Eigen::MatrixXd>& y,
                                             const IdentifiedSensitivityOptions& options = {});

}  // namespace mpm
