#include "analysis/statistics/ratio_of_means.hpp"

#include <cmath>
#include <cstddef>

#include "base/non_finite.hpp"

namespace mpm {

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values)
    sum += value;
  return sum / static_cast<double>(values.size());
}

RatioOfMeans ratio_of_means(std::span<const double> a, std::span<const double> b) {
  const auto n = static_cast<double>(a.size());
  const double ratio = mean_of(a) / mean_of(b);
  if (a.size() < 2)
    return {ratio, kNaN};
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    squares += std::pow(a[i] - ratio * b[i], 2);
  return {ratio, std::sqrt(squares / (n - 1.0) / n) / mean_of(b)};
}

}  // namespace mpm
