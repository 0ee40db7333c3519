#pragma once

#include <vector>

namespace mpm {

/// Returns a quantile of values in ascending order, interpolated linearly between order statistics (type 7 of
/// Hyndman and Fan 1996): with h = (n - 1) p, x_floor(h) + (h - floor(h)) (x_floor(h)+1 - x_floor(h)). p =
/// 1/2 is the median.
/// @throws InputError for no values or p outside [0, 1]
double sorted_quantile(const std::vector<double>& sorted, double probability);

/// Returns a median that is itself one of the values, which may be in any order. For an even number of values
/// it is the larger of the two in the middle.
/// @throws InputError for no values
double upper_median(std::vector<double> values);

}  // namespace mpm
