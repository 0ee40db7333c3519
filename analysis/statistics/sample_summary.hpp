#pragma once

#include <cstdint>
#include <vector>

#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// Least, mean and largest value of a quantity over experiments, with a t interval of the mean.
struct SampleSummary {
  std::int64_t count = 0;
  double least = kNaN;
  double mean = kNaN;
  double largest = kNaN;
  Interval mean_interval{kNaN, kNaN};
};

/// Summarises `values` without its NaNs. The interval needs two values.
SampleSummary summarise(const std::vector<double>& values, double confidence);

}  // namespace mpm
