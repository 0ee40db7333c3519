#pragma once

#include <optional>

#include <Eigen/Core>

#include "base/non_finite.hpp"
#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// A transfer function that was fitted to a step response.
struct StepResponseFit {
  TransferFunction channel = TransferFunction::zero();
  double rms_error = kNaN;      ///< in the unit of the response
  double explained = kNaN;      ///< 1 - sum of squared errors over sum of squares; 1 for a zero response
  double largest_error = kNaN;  ///< as a share of the largest value of the response; 0 for a zero one
};

/// If the largest error of a fit, as a share of the largest value of the response, is below this number, no
/// richer form is needed. The first is for a plant, which may be nonlinear, the second for rounded
/// coefficients.
inline constexpr double kNegligibleOfPlant = 1e-3, kNegligibleOfCoefficients = 1e-6;

/// Fits, by least squares, the simplest of these forms that describes the unit step response `response`
/// (values 1, 2, ... sample times after the step):
///
///   0,   K e^{-theta s}/(tau s + 1),   (b_1 s + b_0) e^{-theta s}/(tau^2 s^2 + 2 tau xi s + 1),
///
/// where b_1 is 0 or free. If the response still rises or falls at its end as it did before, the CV may
/// integrate: K e^{-theta s}/s and the other forms over s are tried as well.
///
/// K and b follow linearly from the other parameters (variable projection), which the Levenberg-Marquardt
/// method finds from several starting points. The simplest form is the one with the least n log(mean squared
/// error + f^2) + p log n, with p parameters and n samples. f is the largest error that needs no richer form:
/// f^2 is the sum of the squares of `negligible`, in the unit of the response, and of `share` times its
/// largest value. Errors: InputError for fewer than 8 samples, numbers that are not finite, or a sample time
/// that is not > 0.
StepResponseFit fit_step_response(const Eigen::Ref<const Eigen::VectorXd>& response, double sample_time,
                                  double negligible, double share = kNegligibleOfPlant);

/// Fits a transfer function to the coefficients of a step response, as dynamic matrix control has them:
/// values 1, 2, ... intervals after a step of 1. Errors: InputError as fit_step_response(), and if there are
/// too few coefficients for the response to settle: it still moves at its end, and is there more than a tenth
/// of its largest value away from the final value of the fit. `negligible` is the uncertainty that the digits
/// of the coefficients leave.
StepResponseFit fit_step_coefficients(const Eigen::VectorXd& coefficients, double interval,
                                      double negligible = 0.0);

/// Returns the channel that has these coefficients (StepCoefficients), with the parameters of a fit to them.
/// If the transfer function gives every coefficient, and what follows the last one, to 1e-9 of the largest,
/// it returns the transfer function alone.
TransferFunction by_coefficients(const StepResponseFit& fit, const Eigen::VectorXd& coefficients,
                                 double interval);

/// Returns `channel` with its numbers rounded to the fewest digits, the same for all of them, with which its
/// response at 1, 2, ... intervals is off by at most `tolerances` from the coefficients. If the coefficients
/// were computed from numbers with few digits, these are found again. None if no number of digits suffices.
std::optional<TransferFunction> with_fewest_digits(const TransferFunction& channel,
                                                   const Eigen::VectorXd& coefficients, double interval,
                                                   const Eigen::VectorXd& tolerances);

/// The final values of a response and of its fit; the final rates if the channel integrates.
struct ResponseEnd {
  double last, fitted;
  double largest;  ///< largest value, or rate, of the response
};
ResponseEnd response_end(const TransferFunction& fit, const Eigen::Ref<const Eigen::VectorXd>& response,
                         double sample_time);

}  // namespace mpm
