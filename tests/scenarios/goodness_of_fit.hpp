#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace mpm::testing {

/// Largest distance between the empirical distribution function of `sample` and `distribution_function`.
template <class Function>
double kolmogorov_distance(std::vector<double> sample, Function distribution_function) {
  std::sort(sample.begin(), sample.end());
  const double n = static_cast<double>(sample.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double p = distribution_function(sample[i]);
    distance = std::max({distance, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  return distance;
}

/// Critical distance at the level 0.001: P(D > 1.9495/sqrt(n)) = 2 exp(-2 * 1.9495^2) = 0.001,
/// asymptotically.
inline double kolmogorov_critical(std::size_t n) {
  return 1.9495 / std::sqrt(static_cast<double>(n));
}

}  // namespace mpm::testing
