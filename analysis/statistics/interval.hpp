#pragma once

#include <cstdint>
#include <vector>

namespace mpm {

/// A closed interval.
struct Interval {
  double lower = 0.0;
  double upper = 0.0;

  bool contains(double value) const { return lower <= value && value <= upper; }
};

/// Returns the z with P(|Z| <= z) = `confidence` for a standard normal Z; 1.96 for 0.95.
/// @throws InputError unless 0 < confidence < 1
double two_sided_normal_quantile(double confidence);

/// Returns Wilson's score interval for the probability of a hit, given k = `hits` in n = `total` trials
/// (Wilson 1927): all p with |k/n - p| <= z sqrt(p (1 - p)/n), that is
///
///   (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),   p = k/n
///
/// [0, 1] for n = 0. The interval contains the true probability with `confidence` on average over p.
/// @throws InputError unless 0 <= hits <= total and 0 < confidence < 1
Interval wilson_interval(std::int64_t hits, std::int64_t total, double confidence = 0.95);

/// Returns the same interval for a share p of n trials, where neither p n nor n needs to be a whole number.
Interval score_interval(double share, double trials, double confidence);

/// Trials and hits within one cluster: trials that share the same draw.
struct ClusterCount {
  std::int64_t hits = 0, total = 0;
};

/// A share of trials with its uncertainty.
struct Rate {
  std::int64_t hits = 0;
  std::int64_t total = 0;
  /// hits/total; NaN without trials.
  double value = 0.0;
  /// Wilson's interval, or that of clustered_rate().
  Interval interval;
  std::vector<ClusterCount> clusters = {};  ///< of the trials; empty if they are independent
  double further_variance = 0.0;            ///< of `value`, beside that of the trials; in `interval`
};

/// Returns the rate of `hits` in `total` trials with Wilson's interval.
/// @throws InputError unless 0 <= hits <= total and 0 < confidence < 1
Rate rate(std::int64_t hits, std::int64_t total, double confidence = 0.95);

/// Returns the interval of the difference d = p1 - p2 of two shares of independent trials, which combines
/// their Wilson intervals (l1, u1) and (l2, u2) (Newcombe 1998, method 10):
///
///   d - sqrt((p1 - l1)^2 + (u2 - p2)^2)   to   d + sqrt((u1 - p1)^2 + (p2 - l2)^2)
///
/// Both ends are NaN if there are no trials. `second` is p2, a share of `total` trials; it may be rounded, so
/// that its number of hits need not be whole.
/// @throws InputError unless 0 <= second <= 1, total >= 0 and 0 < confidence < 1
Interval difference_interval(const Rate& first, double second, std::int64_t total, double confidence = 0.95);

}  // namespace mpm
