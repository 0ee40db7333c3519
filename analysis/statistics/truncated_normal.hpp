#pragma once

#include <vector>

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

/// The quantiles `probability` (inside (0, 1)) of a mixture. Parts without mass take no part; NaN when there
/// is none with mass.
double mixture_quantile(const std::vector<TruncatedNormal>& parts, double probability);

/// log(exp(a) + exp(b)), also for -infinity.
double log_sum(double a, double b);

}  // namespace mpm
