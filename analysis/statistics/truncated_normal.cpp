#include "analysis/statistics/truncated_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plants/non_finite.hpp"

namespace mpm {
namespace {

/// log of the upper tail of the standard normal distribution, z >= 0.
double log_upper_tail(double z) {
  if (z < 30.0)
    return std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
  // Abramowitz and Stegun 26.2.12, whose next term is below 1e-7 here.
  const double inverse = 1.0 / (z * z);
  return -0.5 * z * z - std::log(z * std::sqrt(2.0 * std::numbers::pi)) +
         std::log1p(-inverse * (1.0 - 3.0 * inverse));
}

/// log P(low < Z < high), low < high.
double log_probability(double low, double high) {
  if (high <= 0.0)
    return log_probability(-high, -low);
  if (low >= 0.0) {
    const double tail = log_upper_tail(low);
    return tail + std::log(-std::expm1(log_upper_tail(high) - tail));
  }
  return std::log1p(-std::exp(log_upper_tail(-low)) - std::exp(log_upper_tail(high)));
}

}  // namespace

double log_normal_integral(double low, double high, double mean, double deviation) {
  if (!(low < high))
    return -kInfinity;
  // A density that is flat over the interval: the difference of two tails would lose its digits.
  const double width = (high - low) / deviation;
  const double middle = (0.5 * (low + high) - mean) / deviation;
  if (width * (1.0 + std::abs(middle)) < 1e-4)
    return std::log(high - low) - 0.5 * middle * middle;
  return std::log(deviation * std::sqrt(2.0 * std::numbers::pi)) +
         log_probability((low - mean) / deviation, (high - mean) / deviation);
}

double TruncatedNormal::cumulative(double x) const {
  if (x <= low)
    return 0.0;
  if (x >= high)
    return 1.0;
  return std::min(1.0, std::exp(log_normal_integral(low, x, mean, deviation) -
                                log_normal_integral(low, high, mean, deviation)));
}

double mixture_quantile(const std::vector<TruncatedNormal>& parts, double probability) {
  constexpr double kNegligible = 30.0;  // e^-30 of the largest part
  constexpr int kHalvings = 50;
  double largest = -kInfinity;
  for (const TruncatedNormal& part : parts)
    largest = std::max(largest, part.log_mass);
  if (!std::isfinite(largest))
    return kNaN;
  double low = kInfinity, high = -kInfinity, total = 0.0;
  std::vector<TruncatedNormal> kept;
  for (const TruncatedNormal& part : parts)
    if (part.log_mass > largest - kNegligible) {
      kept.push_back(part);
      low = std::min(low, part.low);
      high = std::max(high, part.high);
      total += std::exp(part.log_mass - largest);
    }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const TruncatedNormal& part : kept)
      below += std::exp(part.log_mass - largest) * part.cumulative(middle);
    (below < probability * total ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  return std::isfinite(larger) ? larger + std::log1p(std::exp(std::min(a, b) - larger)) : larger;
}

}  // namespace mpm
