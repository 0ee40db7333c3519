#pragma once

#include <memory>

#include <Eigen/Core>

namespace mpm {

/// A transfer function has settled after this many times the sum of its time constants: e^-21 = 1e-9.
inline constexpr double kTimesToSettle = 21.0;

/// A step response S(t) by its coefficients, as dynamic matrix control uses it: S(0) = 0, S(T) = s_1, ...,
/// S(n T) = s_n, straight lines in between. After the last coefficient S stays there or, if the channel
/// integrates, goes on with the last slope, (s_n - s_(n-1)) / T.
///
/// Between coefficients S is off by at most T^2 / 8 times the largest curvature of the response from which
/// the coefficients were taken. A value type: copies and changed versions share the coefficients. Changes
/// move S along the time axis; what then lies at t <= 0 is cut off.
class StepCoefficients {
 public:
  /// `interval` is T. Errors: InputError for fewer than two values, one that is not finite, or an interval
  /// that is not finite and > 0.
  StepCoefficients(Eigen::VectorXd values, double interval, bool ramps);

  /// S(t). A t within a relative 1e-9 of an interval from a coefficient gives this coefficient.
  double operator()(double t) const;
  double interval() const { return interval_; }
  /// Time at which the last coefficient is reached.
  double end() const { return start_ + interval_ * static_cast<double>(values_->size()); }
  /// The last coefficient.
  double last() const { return gain_ * (*values_)(values_->size() - 1); }
  bool ramps() const { return ramps_; }
  /// The last slope if the response ramps, otherwise 0.
  double rate() const;

  /// S(Ts), S(2 Ts), ..., until the last coefficient is reached; at least two values.
  Eigen::VectorXd sampled(double sample_time) const;

  /// The means of S over [0, Ts), [Ts, 2 Ts), ..., until all of S has its last value or slope.
  Eigen::VectorXd averaged(double sample_time) const;

  /// factor * S(t).
  StepCoefficients with_gain_scaled(double factor) const;
  /// S(about + (t - about) / factor); if it ramps, `factor` times that, so that its rate stays.
  StepCoefficients with_time_scaled(double factor, double about) const;
  /// S(t - delta).
  StepCoefficients with_dead_time_shifted(double delta) const;

  friend bool operator==(const StepCoefficients& a, const StepCoefficients& b);

 private:
  /// S(t) for t >= 0; at 0 its value right after 0.
  double after_start(double t) const;
  double integral(double from, double to) const;

  std::shared_ptr<const Eigen::VectorXd> values_;
  double interval_;
  bool ramps_;
  double start_ = 0.0, gain_ = 1.0;
};

}  // namespace mpm
