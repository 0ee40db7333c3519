#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"

namespace mpm {

/// An output-error model of one order, and its loss.
struct OutputErrorFit {
  PolynomialModel model;  ///< `noise_variance` is the loss
  double loss = 0.0;      ///< sum e^2/N over the N samples of the record
};

/// Fits output-error models of several outputs from the same inputs, for several orders, from rest. Each
/// search is the one that `identify_prediction_error` makes from its best start, in a fraction of the time,
/// but without a covariance and without a status. If a search is stopped before its end, or if a start
/// depends on nearly dependent regressors, the results of the two differ by magnified rounding errors.
///
/// | symbol | meaning                                     | shape  |
/// |--------|---------------------------------------------|--------|
/// | u      | inputs, deviations from the operating point | nu x N |
/// | y      | output, deviation from it                   | N      |
class OutputErrorFits {
 public:
  OutputErrorFits(const Eigen::Ref<const Eigen::MatrixXd>& u, int max_iterations);

  /// Returns a model for each of the orders nf. With `delay` 0, B/F is a proper function of this order.
  /// Otherwise it is strictly proper, and B has nf coefficients.
  /// @throws InputError as `identify_prediction_error`
  std::vector<OutputErrorFit> fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                                  const std::vector<Eigen::Index>& orders, Eigen::Index delay) const;

 private:
  Eigen::MatrixXd u_;
  Eigen::VectorXd unit_;  ///< of each input, in which its size is about 1
  int max_iterations_;
};

}  // namespace mpm
