#pragma once

#include <Eigen/Core>

namespace mpm {

/// The model G_d0 = C/D of the disturbance at one output, with polynomials in q^-1 that begin with 1. The
/// default is 1: the output error is white.
struct NoiseModel {
  Eigen::VectorXd C = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd D = Eigen::VectorXd::Ones(1);

  /// The order of the difference equation that gives e^p.
  Eigen::Index order() const;
};

/// G_d0 = (1 - c q^-1)/(1 - q^-1), integrated noise plus white noise. The predictor is the sum of the past
/// output errors, weighted with (1 - c) c^i. With c = 0 it repeats the last error, as the output bias of the
/// controller does.
/// @throws InputError for c outside [0, 1)
NoiseModel integrated_noise(double c);

/// G_d0 = 1/D, the autoregression of order 0 ... `highest_order` with the least BIC for the output errors v =
/// y - y_sim of a record (N) that is known to be good. The order is 0, white noise, if all errors are 0.
/// @throws InputError for an order below 0, values that are not finite, or fewer than 2 samples for each
/// order
NoiseModel autoregressive_noise(const Eigen::Ref<const Eigen::VectorXd>& v, Eigen::Index highest_order);

/// The variance of the innovations of a record about its mean, by the same autoregression: the sum of their
/// squares from sample `highest_order` on over the remaining degrees of freedom.
/// @throws InputError as `autoregressive_noise`
double innovation_variance(const Eigen::Ref<const Eigen::VectorXd>& v, Eigen::Index highest_order);

/// One-step prediction errors with the disturbance model (2.2), (2.3), (A1.2), (A1.3) (Ljung 1999, eq. 3.20),
///
///   y_hat = G_d0^-1 G_0 u + (1 - G_d0^-1) y,    e^p = y_hat - y = G_d0^-1 (y_sim - y)
///
/// | symbol | meaning                                              | shape |
/// |--------|------------------------------------------------------|-------|
/// | y      | measured CV                                          | N     |
/// | y_sim  | G_0 u, the model's output with the plant's inputs up to k - 1 | N |
/// | e^p    | prediction errors; what was before the record is 0   | N     |
///
/// @throws InputError for different lengths or a polynomial that does not begin with 1
Eigen::VectorXd one_step_errors(const NoiseModel& model, const Eigen::Ref<const Eigen::VectorXd>& y,
                                const Eigen::Ref<const Eigen::VectorXd>& y_sim);

}  // namespace mpm
