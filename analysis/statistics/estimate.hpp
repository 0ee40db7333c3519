#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// Sum and number of the values within one cluster: values that share the same draw.
struct ClusterSum {
  double sum = 0.0;
  std::int64_t count = 0;
};

/// An estimated number with its uncertainty.
struct Estimate {
  double value = kNaN;                    ///< NaN if nothing was estimated
  Interval interval{kNaN, kNaN};          ///< NaN if there is none
  std::int64_t count = 0;                 ///< number of values behind `value`
  std::vector<ClusterSum> clusters = {};  ///< the values of a clustered_mean()
};

/// Returns the mean of values, without an interval.
Estimate mean_estimate(const std::vector<double>& values);

/// Returns the median of values. Some values may be infinite, such as a delay that had not ended when the
/// observation did. The interval consists of order statistics (David and Nagaraja 2003, 7.1): with n values
/// in ascending order it is [x_(l), x_(n+1-l)], where l is the largest number with P(B(n, 1/2) < l) <= (1 -
/// confidence) / 2. It contains the median of any distribution with `confidence`; at 95 % there is no
/// interval for fewer than 6 values. With an even n the two values in the middle are averaged. No value may
/// be NaN.
/// @throws InputError unless 0 < confidence < 1
Estimate median_estimate(std::vector<double> values, double confidence);

/// Returns the rate of a Poisson process that showed `events` events in `exposure`, with Garwood's exact
/// interval (1936): chi^2_{alpha/2}(2 events) / 2 to chi^2_{1-alpha/2}(2 events + 2) / 2, each divided by the
/// exposure. NaN if the exposure is 0.
/// @throws InputError for a negative number of events, or unless 0 < confidence < 1
Estimate poisson_rate(std::int64_t events, double exposure, double confidence);

}  // namespace mpm
