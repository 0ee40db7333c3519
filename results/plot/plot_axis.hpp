#pragma once

#include <string>
#include <vector>

#include "base/non_finite.hpp"

namespace mpm {

/// An axis of a panel. A limit that is NaN follows from what is drawn, with a margin; so do both where those
/// that are set leave no room between them.
struct Axis {
  std::string label;  ///< label, with the unit
  bool logarithmic = false;
  double lower = kNaN;
  double upper = kNaN;
  std::vector<double> ticks = {};       ///< where numbers stand; chosen by themselves when empty
  std::vector<std::string> words = {};  ///< words at 0, 1, 2, ... in place of numbers
};

/// A number for gnuplot, with enough digits for any screen or printer; "NaN" of one that is not finite.
std::string plot_number(double value);

/// Whether the axis has a place for the value: it is finite, far enough from overflow for arithmetic with it,
/// and positive where the axis wants that.
bool shows_value(const Axis& axis, double value);

/// Range, label and ticks of the axis 'x' or 'y' in gnuplot's words, for values from `least` to `largest`
/// (none when least > largest) and an axis of about `length` pixels.
std::string axis_commands(char which, const Axis& axis, double least, double largest, double length);

}  // namespace mpm
