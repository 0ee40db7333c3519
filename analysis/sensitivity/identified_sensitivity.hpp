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
  /// Orders to choose from for each CV. By default all paths of the Box-Jenkins models have the delay 1,
  /// because the controller answers at the sample at which the reference moves, and the plant one sample
  /// later. Dead time shows as small leading coefficients of B, or is found by further delays in the grid.
  OrderGrid orders{{0}, {2, 3, 4}, {2, 3, 4}, {1}, {1}, {1}};
  /// Options of the order selection and of the search. `selection.fit.start` is the state before the record.
  OrderSelectionOptions selection;

  /// @throws InputError for fewer than 1 sample or invalid options of the selection
  void validate() const;
};

/// The part of an identified T0 that belongs to one CV.
struct IdentifiedRow {
  /// The identification on the whole record with the selected orders. Its model has one input for each
  /// reference. If the CV stands still (to rounding), no reference has an effect: the model is 0, and the
  /// status is noise_free.
  Identification identification;
  /// %Fit (3.32) on the validation data, of the model identified from the estimation data alone. NaN for a CV
  /// at rest.
  double validation_fit = 0.0;
};

/// T0 identified from a record of a closed loop.
struct IdentifiedSensitivity {
  /// [reference] ny x samples; column l-1 holds the outputs l samples after a unit step in that reference.
  /// This is the layout of `NominalSensitivity::step_response`, with references instead of active limits. NaN
  /// in the row of a CV without a usable model.
  std::vector<Eigen::MatrixXd> step_response;
  std::vector<IdentifiedRow> rows;  ///< one for each CV
};

/// Identifies T0 from a simulation of the controller on its own model with excited references (appendix A3 of
/// the thesis, (A3.1), (A3.2)). Each CV has a Box-Jenkins model with one output and all references as inputs:
///
///   y_i = sum_j T0_ij r_j + (C_i/D_i) e_i
///
/// | symbol | meaning                                                        | shape     | unit        |
/// |--------|----------------------------------------------------------------|-----------|-------------|
/// | r      | references (setpoints or active limits), deviations            | n_ref x N | of their CV |
/// | y      | outputs of the simulation, deviations; y(k) from r up to k - 1 | ny x N    | of the CV   |
///
/// For each CV, the orders are those of the grid with the best criterion on the end of the record, which must
/// therefore be excited as well. The model is then identified again on the whole record. All references may
/// move at once if the loop is linear. A range MPC is not linear: move one limit at a time, in one direction
/// (docs/methods.md, Identification), with one call for each.
/// @throws InputError for different lengths, values that are not finite, no reference, too short a record, or
///   invalid options
IdentifiedSensitivity identified_sensitivity(const Eigen::Ref<const Eigen::MatrixXd>& r,
                                             const Eigen::Ref<const Eigen::MatrixXd>& y,
                                             const IdentifiedSensitivityOptions& options = {});

}  // namespace mpm
