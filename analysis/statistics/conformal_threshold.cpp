#include "analysis/statistics/conformal_threshold.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Relative margin that keeps rounding from losing a product that is meant to be whole, such as 20 times
/// 0.05.
constexpr double kRounding = 1e-12;

void require_false_alarms(double false_alarms) {
  if (!(false_alarms > 0.0 && false_alarms < 1.0))
    throw InputError("rate of false alarms", fmt::format("{}", false_alarms), "a number between 0 and 1");
}

/// n + 1 - k = floor((n + 1) a): the place of the threshold counted from the top; 0 if there is no threshold.
std::int64_t places_from_top(std::int64_t count, double false_alarms) {
  return static_cast<std::int64_t>(
      std::floor(static_cast<double>(count + 1) * false_alarms * (1.0 + kRounding)));
}

}  // namespace

std::optional<double> conformal_threshold(std::span<const double> scores, double false_alarms) {
  require_false_alarms(false_alarms);
  const std::int64_t place = places_from_top(std::ssize(scores), false_alarms);
  if (place < 1)
    return std::nullopt;
  std::vector<double> descending(scores.begin(), scores.end());
  for (double& score : descending)
    score = std::isnan(score) ? -kInfinity : score;
  std::sort(descending.begin(), descending.end(), std::greater<>());
  return descending[static_cast<std::size_t>(place - 1)];
}

std::int64_t fewest_scores(double false_alarms) {
  require_false_alarms(false_alarms);
  constexpr double kMost = 1e15;
  const double count = std::ceil((1.0 - kRounding) / false_alarms) - 1.0;
  return static_cast<std::int64_t>(std::clamp(count, 1.0, kMost));
}

}  // namespace mpm
