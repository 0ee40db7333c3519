#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// Criterion for the order of an output-error model of Badwe et al. (2010).
enum class DesignedOrderCriterion : std::int8_t {
  record_fit = 0,      ///< largest %Fit (3.32) over the record to which the models are fitted
  validation_fit = 1,  ///< largest %Fit over the end of the record, of models fitted to the part before it;
                       ///< the chosen order is then fitted to the whole record
  bic = 2,             ///< smallest n log V + p log n over the record
};

/// Options of `designed_output`.
struct DesignedOutputOptions {
  /// The orders n to try: F has order n, and B is such that B/F is a proper function of order n (S_d) or one
  /// with a delay of one sample (Delta G K). Section 3.3.2 varies them "between 3 and 7".
  std::vector<Eigen::Index> orders{3, 4, 5, 6, 7};
  DesignedOrderCriterion criterion = DesignedOrderCriterion::record_fit;
  /// The share of the record, at its end, that `validation_fit` keeps for validation.
  double validation_share = 0.3;
  /// Iterations of the search for each model; 20 is the default of Matlab's `oe`.
  int max_iterations = 20;
  /// A residual y - y_hat, or an eps, is taken as rounding if its root mean square is below this share of the
  /// largest of the eps, as for a model without mismatch; nothing is identified from it.
  double resolution = 1e-9;

  /// @throws InputError for no order or an order below 1, a share outside (0, 1), fewer than 1 iteration or a
  /// resolution outside [0, 1)
  void validate() const;
};

/// Whether there was a model to identify.
enum class ClosedLoopModelStatus : std::int8_t {
  identified = 0,
  zero = 1,      ///< the output is 0 to rounding, and so is the model
  no_model = 2,  ///< no order gave a model with a finite output
};

template <>
inline constexpr auto kWords<ClosedLoopModelStatus> = word_list("identified", "zero", "no model");

/// One row of S_d or Delta G K: an output-error model from all eps (`oe` of one output in Matlab).
struct ClosedLoopModel {
  ClosedLoopModelStatus status = ClosedLoopModelStatus::no_model;
  PolynomialModel model;   ///< one path for each eps; B = 0 for an eps that stands still
  Eigen::Index order = 0;  ///< n; 0 if there is no model
  /// %Fit (3.32) of the simulated output of the model over the record; NaN for an output of 0.
  double fit = kNaN;
};

/// The designed outputs of a loop, and the models behind them.
struct DesignedOutput {
  Eigen::MatrixXd eps;                       ///< controller inputs (3.2), ny x N
  std::vector<ClosedLoopModel> sensitivity;  ///< rows of S_d (3.3)
  std::vector<ClosedLoopModel> mismatch;     ///< rows of Delta G K (3.5)
  Eigen::MatrixXd y0;                        ///< (3.7), ny x N; NaN in rows that lack a model

  /// Whether CV i has a designed output: its row of S_d and all rows of Delta G K were found.
  bool has(Eigen::Index i) const;
};

/// The controller inputs of the IMC structure, eps = y_set - (y - y_hat) (3.2), figure 3.1.
/// @throws InputError for different shapes
Eigen::MatrixXd controller_inputs(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                  const Eigen::Ref<const Eigen::MatrixXd>& y_hat,
                                  const Eigen::Ref<const Eigen::MatrixXd>& y_set);

/// The outputs that a loop would have had with a perfect model, estimated from its routine data alone. The
/// method is by Badwe, Patwardhan, Shah, Patwardhan and Gudi, "Quantifying the impact of model-plant mismatch
/// on controller performance", J. Process Control 20 (2010) 408-425, in the form of section 3.1 of the
/// thesis. With the IMC controller K, u = K eps, the plant G, its model G0, Delta G = G - G0 and the
/// disturbance v_s,
///
///   y_set - y = S_d eps,            S_d = I - G0 K                      (3.3), (3.1)
///   y - y_hat = Delta G K eps + v_s                                     (3.5)
///   y0 = y_set - S_d (y_set - v_s) = y_set - S_d (I + Delta G K) eps    (3.4), (3.7)
///
/// Each row of S_d and of Delta G K is one output-error model from all eps. The first equation is exact for a
/// linear controller. The second is fitted in closed loop, where v_s and eps are correlated, so it is biased
/// to the extent that v_s reaches eps. Both properties belong to the published method.
///
/// | symbol | meaning | shape | unit |
/// |--------|---------|-------|------|
/// | y      | measured outputs | ny x N | those of the CVs |
/// | y_hat  | outputs of G0 under the measured inputs | ny x N | the same |
/// | y_set  | setpoints | ny x N | the same |
///
/// The record must begin at rest at its first setpoints. For each row, an order costs one high-order ARX
/// regression and `max_iterations` steps of a search.
/// @throws InputError for different shapes, no CV, values that are not finite, a record with no more samples
///   than the largest model has coefficients, or invalid options
DesignedOutput designed_output(const Eigen::Ref<const Eigen::MatrixXd>& y,
                               const Eigen::Ref<const Eigen::MatrixXd>& y_hat,
                               const Eigen::Ref<const Eigen::MatrixXd>& y_set,
                               const DesignedOutputOptions& options = {});

}  // namespace mpm
