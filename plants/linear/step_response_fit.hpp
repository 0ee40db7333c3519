#pragma once

#include <optional>

#include <Eigen/Core>

#include "base/non_finite.hpp"
#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// A transfer function that was fitted to a step response.
struct StepResponseFit {
  TransferFunction channel = TransferFunction::zero();
  double rms_error = kNaN;      ///< of the response, in its unit
  double explained = kNaN;      ///< 1 - sum of squared errors over sum of squares; 1 for no response at all
  double largest_error = kNaN;  ///< of the response, as a share of its largest value; 0 for no response
};

/// Largest error of a fit that needs no richer form, as a share of the largest value of the response: for
/// a plant, which may be nonlinear, and for coefficients, which are rounded.
inline constexpr double kNegligibleOfPlant = 1e-3, kNegligibleOfCoefficients = 1e-6;

/// The simplest of these forms that describes the unit step response `response` (values 1, 2, ... sample
/// times after the step), by least squares:
///
///   0,   K e^{-theta s}/(tau s + 1),   (b_1 s + b_0) e^{-theta s}/(tau^2 s^2 + 2 tau xi s + 1), b_1 = 0 or
///   free,
///
/// and where the response still rises or falls at its end as it did before, the CV integrates: K e^{-theta
/// s}/s and the others over s.
///
/// K and b follow linearly from the others (variable projection), which the Levenberg-Marquardt method finds
/// from several starting points. The simplest is the one with the least n log(mean squared error + f^2) + p
/// log n, with p parameters and n samples. f is the largest error that needs no richer form: `negligible`, in
/// the unit of the response, and `share` of its largest value. Errors: InputError for fewer than 8 samples,
/// numbers that are not finite, or a sample time that is not > 0.
StepResponseFit fit_step_response(const Eigen::Ref<const Eigen::VectorXd>& response, double sample_time,
                                  double negligible, double share = kNegligibleOfPlant);

/// The transfer function that fits the coefficients of a step response, as dynamic matrix control has them:
/// values 1, 2, ... intervals after a step of 1. Errors: InputError as fit_step_response(), and for a
/// response that has not settled, because the coefficients are too few: at its end it still moves and is more
/// than a tenth of the largest one away from the final value of the fit. `negligible` is the uncertainty that
/// their digits leave.
StepResponseFit fit_step_coefficients(const Eigen::VectorXd& coefficients, double interval,
                                      double negligible = 0.0);

/// The channel that has these coefficients (StepCoefficients), with the parameters of a fit to them: the
/// transfer function alone where it gives every coefficient, and what follows the last one, to 1e-9 of the
/// largest.
TransferFunction by_coefficients(const StepResponseFit& fit, const Eigen::VectorXd& coefficients,
                                 double interval);

/// `channel` with the fewest digits in its numbers, the same in all of them, with which its response at 1, 2,
/// ... intervals is off by at most `tolerances` from the coefficients: the numbers as they were given where
/// the coefficients were made of some. None where no number of digits does.
std::optional<TransferFunction> with_fewest_digits(const TransferFunction& channel,
                                                   const Eigen::VectorXd& coefficients, double interval,
                                                   const Eigen::VectorXd& tolerances);

/// The final values of a response and of its fit; rates if the channel integrates.
struct ResponseEnd {
  double last, fitted;
  double largest;  ///< of the response
};
ResponseEnd response_end(const TransferFunction& fit, const Eigen::Ref<const Eigen::VectorXd>& response,
                         double sample_time);

}  // namespace mpm
