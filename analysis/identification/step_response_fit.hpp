#pragma once

#include <Eigen/Core>

#include "plants/linear/transfer_function.hpp"
#include "plants/non_finite.hpp"

namespace mpm {

/// A transfer function that was fitted to a step response.
struct StepResponseFit {
  TransferFunction channel = TransferFunction::zero();
  double rms_error = kNaN;  ///< of the response, in its unit
  double explained = kNaN;  ///< 1 - sum of squared errors over sum of squares; 1 for no response at all
};

/// The simplest of these forms that describes the unit step response `response` (values 1, 2, ... sample
/// times after the step), by least squares:
///
///   0,   K e^{-theta s}/(tau s + 1),   (b_1 s + b_0) e^{-theta s}/(tau^2 s^2 + 2 tau xi s + 1), b_1 = 0 or
///   free.
///
/// K and b follow linearly from the others (variable projection), which the Levenberg-Marquardt method finds
/// from several starting points. The simplest is that with the least n log(mean squared error + f^2) +
/// p log n: p parameters, n samples. f is what an error may be without a reason for a richer form:
/// `negligible`, in the unit of the response, and 1e-3 of its largest value. Errors: InputError for fewer
/// than 8 samples, numbers that are not finite, or a sample time that is not > 0.
StepResponseFit fit_step_response(const Eigen::Ref<const Eigen::VectorXd>& response, double sample_time,
                                  double negligible);

}  // namespace mpm
