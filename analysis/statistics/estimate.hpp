#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// Values within one cluster: values that share the same draw.
struct ClusterSum {
  double sum = 0.0;
  std::int64_t count = 0;
};

/// A number that was found, with its uncertainty.
struct Estimate {
  double value = kNaN;                    ///< NaN: of nothing
  Interval interval{kNaN, kNaN};          ///< NaN: none
  std::int64_t count = 0;                 ///< values behind it
  std::vector<ClusterSum> clusters = {};  ///< of a clustered_mean(): its values
};

/// The mean of values, without an interval.
Estimate mean_estimate(const std::vector<double>& values);

/// The median of values, of which some may be infinite (as a delay is that did not end while somebody
/// looked), with the order statistics as its interval (David and Nagaraja 2003, 7.1): with n values in
/// ascending order [x_(l), x_(n+1-l)], l the largest number with P(B(n, 1/2) < l) <= (1 - confidence) / 2. It
/// holds the median of any distribution with `confidence`; there is none for fewer than 6 values at 95 %.
/// With an even n the two values in the middle are averaged. No value may be NaN.
/// @throws InputError unless 0 < confidence < 1
Estimate median_estimate(std::vector<double> values, double confidence);

/// The rate of a Poisson process of which `events` were seen in `exposure`, with Garwood's exact interval
/// (1936): chi^2_{alpha/2}(2 events) / 2 to chi^2_{1-alpha/2}(2 events + 2) / 2 over the exposure. NaN
/// without exposure.
/// @throws InputError for a negative number of events, or unless 0 < confidence < 1
Estimate poisson_rate(std::int64_t events, double exposure, double confidence);

}  // namespace mpm
