#pragma once

#include <span>

namespace mpm {

/// A ratio of two means with its standard error.
struct RatioOfMeans {
  double value, error;
};

/// Returns r = mean(a) / mean(b) over n pairs (a_i, b_i), with the standard error of the delta method,
///
///     sqrt(sum_i (a_i - r b_i)^2 / (n (n - 1))) / mean(b)
///
/// The standard error is NaN for a single pair. There must be at least one pair.
RatioOfMeans ratio_of_means(std::span<const double> a, std::span<const double> b);

/// Returns the mean of one or more values.
double mean_of(std::span<const double> values);

}  // namespace mpm
