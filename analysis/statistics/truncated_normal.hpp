#pragma once

#include <vector>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// log of the integral of exp(-((x - mean) / deviation)^2 / 2) from `low` to `high`, also where both ends lie
/// far in one tail. -infinity for low >= high. `deviation` > 0; it may be infinite.
double log_normal_integral(double low, double high, double mean, double deviation);

/// A normal density cut off outside of [low, high], with the weight exp(log_mass) in a mixture.
struct TruncatedNormal {
  double log_mass;
  double mean, deviation;  ///< before it is cut off
  double low, high;

  /// P(X <= x) of this one alone.
  double cumulative(double x) const;
};

/// The quantile `probability` (in [0, 1]) of a mixture, those of 0 and 1 the ends of its support. Parts
/// without mass take no part; NaN when there is none with mass.
double mixture_quantile(const std::vector<TruncatedNormal>& parts, double probability);

/// The shortest interval that holds the share `probability` (inside (0, 1)) of a mixture, between two of its
/// quantiles, in steps of a fiftieth of what is left out. Where the density is highest at an end of the
/// support, that end belongs to it, which it never does to the interval that leaves out the same at both
/// ends. NaN without a part that has mass.
Interval shortest_interval(const std::vector<TruncatedNormal>& parts, double probability);

/// log(exp(a) + exp(b)), also for -infinity.
double log_sum(double a, double b);

}  // namespace mpm
