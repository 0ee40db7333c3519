#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// Least, mean and largest value of a quantity over experiments, with a t interval of the mean.
struct SampleSummary {
  std::int64_t count = 0;
  double least = std::numeric_limits<double>::quiet_NaN();
  double mean = std::numeric_limits<double>::quiet_NaN();
  double largest = std::numeric_limits<double>::quiet_NaN();
  Interval mean_interval{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
};

/// Summary of `values` without its NaNs; the interval needs two values.
SampleSummary summarise(const std::vector<double>& values, double confidence);

}  // namespace mpm
