#pragma once

#include <vector>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// Returns the log of the integral of exp(-((x - mean) / deviation)^2 / 2) from `low` to `high`, even if both
/// ends lie far in one tail. -infinity for low >= high. `deviation` > 0; it may be infinite.
double log_normal_integral(double low, double high, double mean, double deviation);

/// A normal density truncated to [low, high], with the weight exp(log_mass) in a mixture.
struct TruncatedNormal {
  double log_mass;
  double mean, deviation;  ///< before truncation
  double low, high;

  /// Returns P(X <= x) for this density alone.
  double cumulative(double x) const;
};

/// Returns the quantile `probability` (in [0, 1]) of a mixture. The quantiles 0 and 1 are the ends of its
/// support. Parts without mass do not count; NaN if no part has mass.
double mixture_quantile(const std::vector<TruncatedNormal>& parts, double probability);

/// Returns the shortest interval that contains the share `probability` (inside (0, 1)) of a mixture. The
/// share left out below it is tried in steps of a fiftieth of 1 - `probability`. If the density is highest at
/// an end of the support, the interval includes that end; an interval that leaves out the same share at both
/// ends never does. NaN if no part has mass.
Interval shortest_interval(const std::vector<TruncatedNormal>& parts, double probability);

/// Returns log(exp(a) + exp(b)), also if a or b is -infinity.
double log_sum(double a, double b);

}  // namespace mpm
