#pragma once

#include <string>
#include <vector>

#include "base/non_finite.hpp"

namespace mpm {

/// An axis of a panel. A limit that is NaN follows from the data, with a margin. If the given limits leave no
/// range between them, both limits follow from the data.
struct Axis {
  std::string label;  ///< label, with the unit
  bool logarithmic = false;
  double lower = kNaN;
  double upper = kNaN;
  std::vector<double> ticks = {};       ///< where numbers stand; empty: chosen automatically
  std::vector<std::string> words = {};  ///< labels for 0, 1, 2, ... in place of numbers
};

/// Formats a number for gnuplot, with enough digits for any screen or printer; "NaN" if it is not finite.
std::string plot_number(double value);

/// Tells whether the axis can show the value: it must be finite, far enough from overflow for arithmetic, and
/// positive if the axis is logarithmic.
bool shows_value(const Axis& axis, double value);

/// Returns range, label and ticks of the axis 'x' or 'y' as gnuplot commands. The values run from `least` to
/// `largest` (no values if least > largest), and the axis is about `length` pixels long.
std::string axis_commands(char which, const Axis& axis, double least, double largest, double length);

}  // namespace mpm
