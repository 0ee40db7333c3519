#pragma once

#include <limits>

namespace mpm {

/// A limit that does not exist: no finite number lies beyond it.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A number that is unknown or has no meaning in its place.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace mpm
