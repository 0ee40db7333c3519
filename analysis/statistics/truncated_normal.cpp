#include "analysis/statistics/truncated_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/best_candidate.hpp"
#include "base/non_finite.hpp"

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
  // The density is nearly flat over the interval, where the difference of two tails would lose its digits.
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

namespace {

/// The parts of a mixture that have mass, with its quantiles.
class Mixture {
 public:
  explicit Mixture(const std::vector<TruncatedNormal>& parts) {
    constexpr double kNegligible = 30.0;  // e^-30 of the largest part
    for (const TruncatedNormal& part : parts)
      largest_ = std::max(largest_, part.log_mass);
    for (const TruncatedNormal& part : parts)
      if (std::isfinite(largest_) && part.log_mass > largest_ - kNegligible) {
        kept_.push_back(part);
        low_ = std::min(low_, part.low);
        high_ = std::max(high_, part.high);
        total_ += std::exp(part.log_mass - largest_);
      }
  }

  double quantile(double probability) const {
    constexpr int kHalvings = 50;
    if (kept_.empty())
      return kNaN;
    if (probability <= 0.0 || probability >= 1.0)
      return probability <= 0.0 ? low_ : high_;
    double low = low_, high = high_;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      double below = 0.0;
      for (const TruncatedNormal& part : kept_)
        below += std::exp(part.log_mass - largest_) * part.cumulative(middle);
      (below < probability * total_ ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  std::vector<TruncatedNormal> kept_;
  double largest_ = -kInfinity;
  double low_ = kInfinity, high_ = -kInfinity, total_ = 0.0;
};

}  // namespace

double mixture_quantile(const std::vector<TruncatedNormal>& parts, double probability) {
  return Mixture(parts).quantile(probability);
}

Interval shortest_interval(const std::vector<TruncatedNormal>& parts, double probability) {
  constexpr int kSteps = 50;
  const Mixture mixture(parts);
  Interval shortest{kNaN, kNaN};
  for (int step = 0; step <= kSteps; ++step) {
    const double below = (1.0 - probability) * step / kSteps;
    const Interval each{mixture.quantile(below),
                        mixture.quantile(step == kSteps ? 1.0 : below + probability)};
    if (!(each.upper - each.lower >= shortest.upper - shortest.lower))
      shortest = each;
  }
  return shortest;
}

double log_sum(double a, double b) {
  const double larger = larger_or_nan(a, b);
  return std::isfinite(larger) ? larger + std::log1p(std::exp(std::min(a, b) - larger)) : larger;
}

}  // namespace mpm
