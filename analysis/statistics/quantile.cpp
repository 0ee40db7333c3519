#include "analysis/statistics/quantile.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

double sorted_quantile(const std::vector<double>& sorted, double probability) {
  if (sorted.empty()) {
    throw InputError("number of values of a quantile", "0", "1 or more");
  }
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw InputError("probability of a quantile", fmt::format("{}", probability), "0 to 1");
  }
  assert(std::is_sorted(sorted.begin(), sorted.end()));
  const double position = static_cast<double>(sorted.size() - 1) * probability;
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double upper_median(std::vector<double> values) {
  if (values.empty())
    throw InputError("number of values of a median", "0", "1 or more");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace mpm
