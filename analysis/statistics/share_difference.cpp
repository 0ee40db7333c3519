#include "analysis/statistics/share_difference.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/hypergeometric.hpp>
#include <fmt/format.h>

#include "analysis/statistics/mcnemar.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

/// Newcombe's correlation of the two answers.
double corrected_phi(const PairedCounts& n) {
  const auto real = [](std::int64_t count) { return static_cast<double>(count); };
  const double margins = real(n.both + n.first) * real(n.second + n.neither) * real(n.both + n.second) *
                         real(n.first + n.neither);
  if (margins == 0.0)
    return 0.0;
  const double excess = real(n.both) * real(n.neither) - real(n.first) * real(n.second);
  return (excess > 0.0 ? std::max(0.0, excess - 0.5 * real(n.total())) : excess) / std::sqrt(margins);
}

/// Wilson's intervals of two shares combined.
Interval combined(const Rate& first, const Rate& second, double phi) {
  const auto radius = [phi](double a, double b) {
    return std::sqrt(std::max(0.0, a * a - 2.0 * phi * a * b + b * b));
  };
  const double difference = second.value - first.value;
  return {difference - radius(second.value - second.interval.lower, first.interval.upper - first.value),
          difference + radius(second.interval.upper - second.value, first.value - first.interval.lower)};
}

/// Fisher's exact test, two-sided.
double fisher_p(const Rate& first, const Rate& second) {
  const std::int64_t hits = first.hits + second.hits, total = first.total + second.total;
  if (hits == 0 || hits == total)
    return 1.0;
  const boost::math::hypergeometric_distribution<> tables(
      static_cast<unsigned>(hits), static_cast<unsigned>(first.total), static_cast<unsigned>(total));
  const auto probability = [&](std::int64_t k) { return boost::math::pdf(tables, static_cast<unsigned>(k)); };
  // The mirrored table of two equal groups has the same probability only to rounding.
  const double found = probability(first.hits) * (1.0 + 1e-9);
  double p = 0.0;
  for (std::int64_t k = std::max<std::int64_t>(0, hits - second.total); k <= std::min(hits, first.total); ++k)
    if (const double each = probability(k); each <= found)
      p += each;
  return std::min(1.0, p);
}

}  // namespace

void PairedCounts::add(bool in_first, bool in_second) {
  ++(in_first ? in_second ? both : first : in_second ? second : neither);
}

ShareDifference paired_difference(const PairedCounts& counts, double confidence) {
  for (const std::int64_t count : {counts.both, counts.first, counts.second, counts.neither})
    if (count < 0)
      throw InputError("number of cases", fmt::format("{}", count), "0 or more");
  const std::int64_t total = counts.total();
  const Rate first = rate(counts.both + counts.first, total, confidence);
  const Rate second = rate(counts.both + counts.second, total, confidence);
  if (total == 0)
    return {kNaN, {kNaN, kNaN}, kNaN};
  return {second.value - first.value, combined(first, second, corrected_phi(counts)),
          mcnemar_test(counts.first, counts.second).p_two_sided};
}

ShareDifference independent_difference(const Rate& first, const Rate& second, double confidence) {
  const Rate a = rate(first.hits, first.total, confidence);
  const Rate b = rate(second.hits, second.total, confidence);
  if (a.total == 0 || b.total == 0)
    return {kNaN, {kNaN, kNaN}, kNaN};
  return {b.value - a.value, combined(a, b, 0.0), fisher_p(a, b)};
}

}  // namespace mpm
