#include "analysis/statistics/interval.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

void require_counts(std::int64_t hits, std::int64_t total) {
  if (total < 0) {
    throw InputError("number of trials", fmt::format("{}", total), "0 or more");
  }
  if (hits < 0 || hits > total) {
    throw InputError("number of hits", fmt::format("{}", hits), fmt::format("0 to {} (the trials)", total));
  }
}

}  // namespace

double two_sided_normal_quantile(double confidence) {
  require_confidence(confidence);
  // Through the upper tail: 1 - alpha/2 would round for a confidence near 1.
  return boost::math::quantile(boost::math::complement(boost::math::normal(), (1.0 - confidence) / 2.0));
}

Interval score_interval(double share, double trials, double confidence) {
  const double p = share, n = trials;
  const double z = two_sided_normal_quantile(confidence);
  if (n == 0.0)
    return {0.0, 1.0};
  const double zz = z * z / n;
  const double middle = (p + zz / 2.0) / (1.0 + zz);
  const double half_width = std::sqrt(zz * p * (1.0 - p) + zz * zz / 4.0) / (1.0 + zz);
  // At p = 0 and p = 1 the formula gives the end 0 or 1 only to within rounding.
  return {p == 0.0 ? 0.0 : std::max(0.0, middle - half_width),
          p == 1.0 ? 1.0 : std::min(1.0, middle + half_width)};
}

Interval wilson_interval(std::int64_t hits, std::int64_t total, double confidence) {
  require_counts(hits, total);
  return total == 0 ? score_interval(0.5, 0.0, confidence)
                    : score_interval(static_cast<double>(hits) / static_cast<double>(total),
                                     static_cast<double>(total), confidence);
}

Rate rate(std::int64_t hits, std::int64_t total, double confidence) {
  const Interval interval = wilson_interval(hits, total, confidence);
  const double value = total > 0 ? static_cast<double>(hits) / static_cast<double>(total) : kNaN;
  return {hits, total, value, interval};
}

Interval difference_interval(const Rate& first, double second, std::int64_t total, double confidence) {
  if (!(second >= 0.0 && second <= 1.0))
    throw InputError("share", fmt::format("{}", second), "0 to 1");
  require_counts(0, total);
  if (first.total == 0 || total == 0)
    return {kNaN, kNaN};
  const Interval one = wilson_interval(first.hits, first.total, confidence);
  const Interval two = score_interval(second, static_cast<double>(total), confidence);
  const double difference = first.value - second;
  return {difference - std::hypot(first.value - one.lower, two.upper - second),
          difference + std::hypot(one.upper - first.value, second - two.lower)};
}

}  // namespace mpm
