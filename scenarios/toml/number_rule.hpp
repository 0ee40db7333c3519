#pragma once

#include <string>

#include "base/non_finite.hpp"

namespace mpm {

/// Which numbers a key of a study file takes: an interval with open or closed ends.
struct NumberRule {
  double low = -kInfinity;
  double high = kInfinity;
  bool low_included = false;
  bool high_included = false;

  /// x > 0
  static NumberRule positive() { return {.low = 0}; }
  /// x >= low, finite
  static NumberRule at_least(double low) { return {.low = low, .low_included = true}; }
  /// Any finite number.
  static NumberRule finite() { return {}; }
  /// 0 <= x <= 1
  static NumberRule share() { return {.low = 0, .high = 1, .low_included = true, .high_included = true}; }
  /// 0 <= x < 1
  static NumberRule below_one() { return {.low = 0, .high = 1, .low_included = true}; }
  /// low < x < high
  static NumberRule inside(double low, double high) { return {.low = low, .high = high}; }

  /// False for NaN.
  bool contains(double value) const;
  /// True when a distribution on [minimum, maximum] keeps to the rule. An infinite end keeps to it if the
  /// rule has the same end.
  bool contains_support(double minimum, double maximum) const;
  /// For messages: "a number > 0".
  std::string text() const;
};

}  // namespace mpm
