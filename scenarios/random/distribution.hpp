#pragma once

#include "scenarios/random/random_stream.hpp"

namespace mpm {

/// The distribution of one real number. A study uses it to say how a mismatch, a gain or a time constant is
/// drawn. It is checked when it is made and never changes afterwards.
///
/// | kind        | a    | b                  | density |
/// |-------------|------|--------------------|---------|
/// | constant    | value| unused             | all weight on a |
/// | uniform     | low  | high               | 1/(b - a) on [a, b) |
/// | log_uniform | low  | high               | 1/(x ln(b/a)) on [a, b]: every ratio equally likely |
/// | normal      | mean | standard deviation | exp(-(x - a)^2/(2 b^2))/(b sqrt(2 pi)) |
class Distribution {
 public:
  /// The shape of the density.
  enum class Kind { constant, uniform, log_uniform, normal };

  /// Always `value`. @throws InputError when it is not finite
  static Distribution constant(double value);
  /// Uniform on [low, high). @throws InputError unless low < high and both are finite
  static Distribution uniform(double low, double high);
  /// A value whose logarithm is uniform. @throws InputError unless 0 < low < high and both are finite
  static Distribution log_uniform(double low, double high);
  /// Normal. @throws InputError unless both are finite and the standard deviation is positive
  static Distribution normal(double mean, double standard_deviation);

  /// Draws one value. Every kind, even the constant, takes exactly one value from the stream, so that later
  /// draws do not depend on the kind.
  double sample(RandomStream& stream) const;

  /// Lower end of the support (-infinity for the normal distribution).
  double minimum() const;
  /// Upper end of the support (+infinity for the normal distribution).
  double maximum() const;

  Kind kind() const { return kind_; }
  /// a and b of the table above; b has no meaning for a constant.
  double first() const { return a_; }
  double second() const { return b_; }

  friend bool operator==(const Distribution&, const Distribution&) = default;

 private:
  Distribution(Kind kind, double a, double b) : kind_(kind), a_(a), b_(b) {}

  Kind kind_;
  double a_;
  double b_;
};

}  // namespace mpm
