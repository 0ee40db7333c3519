#pragma once

#include <span>

namespace mpm {

/// A ratio of two means with its standard error.
struct RatioOfMeans {
  double value, error;
};

/// mean(a) / mean(b) over n pairs (a_i, b_i), with the standard error of the delta method,
///
///     sqrt(sum_i (a_i - r b_i)^2 / (n (n - 1))) / mean(b),    r the ratio;
///
/// NaN for a single pair. Both have one value at least.
RatioOfMeans ratio_of_means(std::span<const double> a, std::span<const double> b);

/// The mean of one value or more.
double mean_of(std::span<const double> values);

}  // namespace mpm
