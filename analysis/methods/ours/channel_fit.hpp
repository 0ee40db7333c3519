#pragma once

#include <optional>

#include <Eigen/Core>

#include "analysis/methods/assessment.hpp"
#include "plants/linear/transfer_function.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {

/// A number that was fitted, with its interval.
struct FittedNumber {
  double value, lower, upper;
  SizeBound bound = SizeBound::none;  ///< the value lies at an end of its search
};

/// A channel of the model, identified again from the record of a loop with all other channels unchanged.
struct ChannelFit {
  FittedNumber gain_factor;      ///< of the gain of the model
  FittedNumber time_factor;      ///< of its time constants
  FittedNumber dead_time_shift;  ///< added to its dead time, time unit of the plant
  Eigen::Index noise_order;      ///< order of the autoregression of the residual of the channel
  double explained;              ///< share of the whitened error of the model that the fit removes, 0 to 1
  TransferFunction channel;      ///< with the values above
};

/// Whether this parameter can be fitted alone, with the others as in the model: gain, time constant, dead
/// time.
bool is_fitted_alone(MismatchParameter parameter);

/// What is known about a record besides the channel that is identified.
struct FitSurroundings {
  /// q x N, CV unit: what other causes may add to e, each row with a coefficient of its own ~ N(0, 1).
  Eigen::MatrixXd unknown = {};
  /// The samples between which the channel begins to change; the change may grow over `longest_growth`
  /// samples. Samples before `earliest` are not fitted. If `earliest` is 0, the channel may also have been
  /// different throughout. No onset: it was.
  struct Onset {
    Eigen::Index earliest, latest, longest_growth;
  };
  std::optional<Onset> onset = {};
  bool asks_intervals = true;  ///< false: both ends of each interval are the value
  double widening = 1.0;       ///< factor of the intervals, above 1 if the noise is no autoregression
};

/// Identifies the channel G of one CV again. With G0 its model, e the simulation error of the CV and u the
/// MV,
///
///   e(k) + r(k) (G0 u)(k) = r(k) g (G(f, s) u)(k) + (Z' z)(k) + c + n(k),   A(q) n(k) = w(k),   z ~ N(0, I)
///
/// G(f, s) is G0 with its time constants times f and its dead time longer by s, g the factor of its gain, and
/// A the autoregression of n whose order has the least BIC. This is an output-error model of one channel with
/// coloured noise, as an unmeasured disturbance is. Z is what is unknown beside the channel, and r the part
/// of the channel that has changed: 1 throughout, or 0 before an onset, 1 after the growth, and a line
/// between. g and c are the least-squares values for each (f, s, r), and z is integrated out. A grid and a
/// pattern search find f, s and r; A and the rest are fitted in turn. The interval of a parameter is that of
/// its profile likelihood: the values with n ln(V / V_min) <= widening^2 chi^2_1, V the least sum of squares
/// over all other parameters.
///
/// | symbol | name    | shape | unit        |
/// |--------|---------|-------|-------------|
/// | e      | e       | N     | CV; NaN where a sample is missing |
/// | u      | u       | N     | MV, u(k) acts from sample k on    |
/// |        | u_start | 1     | MV, at rest before the record     |
/// | Z      | unknown | q x N | CV                                |
///
/// f is searched for in 1/8 ... 8, and s from minus the dead time of G0 to the sum of its dead time, its
/// residence time and a sample, or to a quarter of the record if that is less. An interval ends there, and a
/// value there is a bound, except for a dead time of 0.
///
/// If it is known which parameter is wrong, `only` names it (is_fitted_alone()). The others then stay those
/// of the model, so that none that the record cannot distinguish from it takes its place. Throws InputError
/// for a channel that is zero, an MV that does not move, and a record with too few samples for the fit.
ChannelFit fit_channel(const TransferFunction& nominal, double sample_time,
                       const Eigen::Ref<const Eigen::VectorXd>& e, const Eigen::Ref<const Eigen::VectorXd>& u,
                       double u_start, double confidence, const std::optional<MismatchParameter>& only = {},
                       const FitSurroundings& beside = {});

}  // namespace mpm
