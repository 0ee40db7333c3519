#pragma once

#include <complex>
#include <optional>

#include <Eigen/Core>

#include "plants/linear/step_coefficients.hpp"

namespace mpm {

/// A proper rational transfer function with dead time,
///
///   G(s) = (b_0 s^m + ... + b_m) / (a_0 s^n + ... + a_n) * e^{-theta s},   m <= n, a_0 != 0, theta >= 0.
///
/// | symbol | meaning                 | shape | unit                       |
/// |--------|-------------------------|-------|----------------------------|
/// | b      | numerator()             | m + 1 | output / input * time^(-k) |
/// | a      | denominator()           | n + 1 | time^(-k)                  |
/// | theta  | dead_time()             | 1     | time                       |
///
/// Coefficients stand in descending powers of s. Leading zeros of the numerator are dropped and common
/// factors s are cancelled, so that a zero at the origin and an integrator are never both present;
/// otherwise the coefficients stay as given. A value type: the `with_` functions return a changed copy.
///
/// An output that integrates drifts, and is therefore observed through a washout: with behind_washout() the
/// function is G(s) s / (s + 1 / T_w), which no longer has a pole at the origin. Numerator and denominator
/// are then those of the product, while changes of gain, time constants and dead time apply to G.
///
/// A function may have the coefficients of its step response. Its gains and all simulations then use these
/// coefficients. The rational form is fitted to them and supplies the parameters (poles, residence time, dead
/// time, G(s)); a change of the function changes both.
class TransferFunction {
 public:
  /// Errors: InputError if a coefficient or the dead time is not finite, a polynomial is empty, the leading
  /// denominator coefficient is zero, the function is not proper, or the dead time is negative.
  TransferFunction(Eigen::VectorXd numerator, Eigen::VectorXd denominator, double dead_time = 0);

  /// gain / (time_constant s + 1) * e^{-dead_time s}. Errors: InputError unless `time_constant` > 0.
  static TransferFunction first_order(double gain, double time_constant, double dead_time = 0);

  /// The channel without any effect: 0 / 1.
  static TransferFunction zero();

  const Eigen::VectorXd& numerator() const { return numerator_; }
  const Eigen::VectorXd& denominator() const { return denominator_; }
  double dead_time() const { return dead_time_; }

  /// Number of poles n.
  Eigen::Index order() const { return denominator_.size() - 1; }

  /// G = 0 for every s.
  bool is_zero() const { return numerator_.isZero(0) && !step_; }

  /// Has a pole at the origin, hence no static gain.
  bool is_integrating() const { return !is_zero() && denominator_(order()) == 0; }

  /// G(0); the last coefficient if there are step coefficients. Errors: InputError for an integrating
  /// channel.
  double static_gain() const;

  /// lim s G(s), s -> 0: the rate of an integrating channel under a constant input of 1; 0 for other
  /// channels.
  double rate_gain() const;

  /// G(s) of the rational form, with the dead time as e^{-theta s}. Not finite at a pole.
  std::complex<double> operator()(std::complex<double> s) const;

  /// factor * G(s): a gain mismatch. Errors: InputError unless `factor` is finite.
  TransferFunction with_gain_scaled(double factor) const;

  /// R(factor * s) e^{-theta s} for G(s) = R(s) e^{-theta s}: every time constant of the rational part, zeros
  /// included, is multiplied by `factor`; static gain and dead time stay. The step response of the rational
  /// part obeys y_scaled(factor * t) = y(t). For an integrating channel the rate gain stays, so that the
  /// rational part becomes factor * R(factor * s): a pure integrator does not change. Errors: InputError
  /// unless `factor` is finite and positive.
  TransferFunction with_time_scaled(double factor) const;

  /// G(s) e^{-delta s}: a dead-time mismatch. Errors: InputError if dead_time() + delta is negative or not
  /// finite.
  TransferFunction with_dead_time_shifted(double delta) const;

  /// The mean residence time of the rational part, a_{n-1} / a_n - b_{m-1} / b_m: the time constant of a
  /// first-order function; 0 for a static one. For an integrating channel it is that of s G(s), and behind a
  /// washout that of G.
  double residence_time() const;

  /// Whether with_time_scaled() changes the function: false if it is zero, static or a pure integrator.
  bool has_time_constant() const;

  /// G(s) s / (s + 1 / time_constant): the output behind a first-order high-pass filter. The zero-order-hold
  /// equivalent is exact for the filter of the samples, 1 - (1 - a) z^-1 / (1 - a z^-1) with a = e^(-Ts /
  /// time_constant). Errors: InputError unless `time_constant` > 0.
  TransferFunction behind_washout(double time_constant) const;
  TransferFunction without_washout() const;
  /// Time constant of the washout; 0 for none.
  double washout() const { return washout_; }

  /// The same parameters, but simulated with the coefficients of a step response, which ramps if this
  /// function integrates. Errors: InputError as StepCoefficients.
  TransferFunction with_step_coefficients(const Eigen::VectorXd& values, double interval) const;
  TransferFunction with_step_coefficients(StepCoefficients step) const;
  /// The rational form alone.
  TransferFunction without_step_coefficients() const;
  const std::optional<StepCoefficients>& step_coefficients() const { return step_; }

  /// How long a single input must be remembered: the dead time, or until the last coefficient if that is
  /// later.
  double memory() const { return step_ && step_->end() > dead_time_ ? step_->end() : dead_time_; }

  /// Are all coefficients and the dead time the same? Functions with the same G(s) but other coefficients
  /// differ.
  friend bool operator==(const TransferFunction& a, const TransferFunction& b);

 private:
  /// Returns another function, behind the washout of this one if it has one.
  TransferFunction with_rational_part(Eigen::VectorXd numerator, Eigen::VectorXd denominator,
                                      double dead_time, std::optional<StepCoefficients> step) const;

  Eigen::VectorXd numerator_;
  Eigen::VectorXd denominator_;
  double dead_time_;
  double washout_ = 0;
  Eigen::VectorXd own_numerator_ = {}, own_denominator_ = {};  ///< own coefficients of G, if behind a washout
  std::optional<StepCoefficients> step_ = {};                  ///< step coefficients of G
};

/// p(s) q(s), coefficients in descending powers.
Eigen::VectorXd polynomial_product(const Eigen::VectorXd& p, const Eigen::VectorXd& q);

}  // namespace mpm
