#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"

namespace mpm {

/// An output-error model of one order, and its residual.
struct OutputErrorFit {
  PolynomialModel model;  ///< `noise_variance` is the loss
  double loss = 0.0;      ///< sum e^2/N over the N samples of the record
};

/// Output-error models of several outputs from the same inputs, over several orders, from rest: for each the
/// search that `identify_prediction_error` makes from its best start, without a covariance and a verdict on
/// its end, in a fraction of the time. If a search is stopped before its end, or a start depends on nearly
/// dependent regressors, the two differ by magnified rounding errors.
///
/// | symbol | meaning                                     | shape  |
/// |--------|---------------------------------------------|--------|
/// | u      | inputs, deviations from the operating point | nu x N |
/// | y      | output, deviation from it                   | N      |
class OutputErrorFits {
 public:
  OutputErrorFits(const Eigen::Ref<const Eigen::MatrixXd>& u, int max_iterations);

  /// A model for each of the orders nf: B/F is a proper function of this order with `delay` 0, a strictly
  /// proper one, of nf coefficients, otherwise.
  /// @throws InputError as `identify_prediction_error`
  std::vector<OutputErrorFit> fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                                  const std::vector<Eigen::Index>& orders, Eigen::Index delay) const;

 private:
  Eigen::MatrixXd u_;
  Eigen::VectorXd unit_;  ///< of each input, in which its size is about 1
  int max_iterations_;
};

}  // namespace mpm
