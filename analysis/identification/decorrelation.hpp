#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "analysis/identification/prediction_error_options.hpp"

namespace mpm {

/// The model by which the effect of other signals is removed from a signal.
enum class DecorrelationModel : std::int8_t {
  output_error = 0,  ///< output-error models by search (2.5), (2.6)
  fir = 1,           ///< regression on Laguerre filters, the finite impulse response for a pole of 0
};

/// Orders of the models of a `Decorrelator`.
struct DecorrelationOptions {
  DecorrelationModel model = DecorrelationModel::fir;
  /// Orders of B and F of each path of an output-error model.
  Eigen::Index nb = 2;
  Eigen::Index nf = 2;
  /// Number of filters per input of the regression, including the direct one (L_0).
  Eigen::Index fir_length = 20;
  /// Pole of its Laguerre filters, in [0, 1).
  double fir_pole = 0.9;
  /// How the output-error models are searched for.
  PredictionErrorOptions search{StartState::held, 0, 60};

  /// @throws InputError for nb or fir_length below 1, nf below 0, a pole outside [0, 1) or invalid options of
  ///   the search
  void validate() const;
  bool operator==(const DecorrelationOptions&) const = default;
};

/// What remains of signals when the effect of others is removed.
struct Decorrelation {
  Eigen::MatrixXd residuals;    ///< m x N, about their means
  Eigen::Index parameters = 0;  ///< fitted coefficients per signal
  Eigen::Index unusable = 0;    ///< output-error models without a usable status (`is_usable`)
};

/// Removes from signals what the inputs explain. What remains are the residuals eps = x - V U of each signal
/// x, in deviations from the means and from the steady state of the first sample, where V U is
///
///   output_error:  sum_j (B_j/F_j) u_j, B_j from lag `delay` on (2.5), (2.6)
///   fir:           c + sum_j sum_{i=0}^{n-1} h_ji L_i u_j,  L_0 = 1,
///                  L_i = sqrt(1 - a^2) q^-1/(1 - a q^-1) ((q^-1 - a)/(1 - a q^-1))^(i-1)
///
/// Laguerre filters (Wahlberg 1991) reach as far back as a long impulse response with few coefficients; a = 0
/// gives L_i = q^-i. Filtered inputs are nearly dependent, with singular values of all sizes, so the last
/// bits would decide which columns a pivoted factorisation takes. The regression is therefore a ridge
/// regression on filtered inputs of norm 1. Of a direction with singular value s it leaves the share
/// r^2/(s^2 + r^2), where r is 1e-10 of the norm of all filtered inputs. This is the orthogonal projection,
/// except for directions that are rounding errors. Without inputs the residuals are the deviations from the
/// means. If a search ends without a usable status, its model is used as it is: the residuals are those of a
/// stable model, though perhaps not of the best one. Decorrelation::unusable counts these models.
///
/// | symbol | name    | shape | meaning                          |
/// |--------|---------|-------|----------------------------------|
/// | x      | signals | m x N | signals to be explained          |
/// | u      | inputs  | n x N | signals that explain them        |
///
/// All throw InputError for different lengths, values that are not finite, no more samples than coefficients,
/// or invalid options.
class Decorrelator {
 public:
  Decorrelator(const Eigen::Ref<const Eigen::MatrixXd>& inputs, const DecorrelationOptions& options);

  /// The regression takes little time, because the constructor has factorised the regressors.
  Decorrelation decorrelate(const Eigen::Ref<const Eigen::MatrixXd>& signals, Eigen::Index delay) const;

 private:
  Decorrelation search(Decorrelation result, Eigen::Index delay) const;

  Eigen::MatrixXd inputs_;
  DecorrelationOptions options_;
  Eigen::MatrixXd basis_;  ///< of the filtered inputs; empty without a regression
};

/// The responses of the filters L_0 ... L_(n-1) to each input in turn, N x (inputs n), from the steady state
/// of the first sample.
Eigen::MatrixXd laguerre_responses(const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index length,
                                   double pole);

}  // namespace mpm
