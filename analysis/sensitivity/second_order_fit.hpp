#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "base/non_finite.hpp"

namespace mpm {

/// The second-order form of the diagonal of T0 in (6.24),
///
///   1 - S0 = T0 = 1 / (tau^2 s^2 + 2 tau xi s + 1)
///
/// | symbol | member        | unit               |
/// |--------|---------------|--------------------|
/// | tau    | time_constant | that of the sample time, > 0 |
/// | xi     | damping       | 1, > 0             |
struct SecondOrderModel {
  double time_constant = kNaN;
  double damping = kNaN;
};

/// Returns the unit step response of the model: `samples` values, 1, 2, ... sample times after the step.
/// Throws InputError unless time constant, damping and sample time are > 0.
Eigen::RowVectorXd second_order_response(const SecondOrderModel& model, double sample_time,
                                         Eigen::Index samples);

enum class FitStatus : std::int8_t {
  ok = 0,
  failed = 1,  ///< numbers that are not finite, or no minimum within the limits of time constant and damping
};

/// The least-squares fit of the model to the samples of a step response.
struct SecondOrderFit {
  FitStatus status = FitStatus::failed;
  SecondOrderModel model;   ///< NaN unless ok
  double rms_error = kNaN;  ///< root of the mean squared residual
};

/// Fits (6.24) to a unit step response (1 x L, values 1 ... L sample times after the step) by the
/// Levenberg-Marquardt method over log tau and log xi. It starts from several points and takes the best
/// result: a response that looks like first order has a second, worse minimum at which xi grows without
/// bound. A result with a time constant outside Ts/100 to 100 L Ts or a damping outside 0.01 to 100 is
/// rejected. Throws InputError for fewer than 3 samples or a sample time <= 0.
SecondOrderFit fit_second_order(const Eigen::Ref<const Eigen::RowVectorXd>& step_response,
                                double sample_time);

}  // namespace mpm
