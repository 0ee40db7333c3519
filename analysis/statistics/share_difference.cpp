#include "analysis/statistics/share_difference.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/math/distributions/hypergeometric.hpp>
#include <fmt/format.h>

#include "analysis/statistics/clustered_rate.hpp"
#include "analysis/statistics/student.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Returns Newcombe's correlation phi of the two answers, with the counts scaled to `total` cases.
double corrected_phi(const PairedCounts& n, double total) {
  const double scale = total / static_cast<double>(n.total());
  const auto real = [scale](std::int64_t count) { return scale * static_cast<double>(count); };
  const double margins = real(n.both + n.first) * real(n.second + n.neither) * real(n.both + n.second) *
                         real(n.first + n.neither);
  if (margins == 0.0)
    return 0.0;
  const double excess = real(n.both) * real(n.neither) - real(n.first) * real(n.second);
  return (excess > 0.0 ? std::max(0.0, excess - 0.5 * total) : excess) / std::sqrt(margins);
}

/// Combines the intervals of two shares into one of their difference, as in paired_difference().
Interval combined(const Rate& first, const Rate& second, double phi) {
  const auto radius = [phi](double a, double b) {
    return std::sqrt(std::max(0.0, a * a - 2.0 * phi * a * b + b * b));
  };
  const double difference = second.value - first.value;
  return {difference - radius(second.value - second.interval.lower, first.interval.upper - first.value),
          difference + radius(second.interval.upper - second.value, first.value - first.interval.lower)};
}

/// Returns p of Fisher's exact test, two-sided.
double fisher_p(const Rate& first, const Rate& second) {
  const std::int64_t hits = first.hits + second.hits, total = first.total + second.total;
  if (hits == 0 || hits == total)
    return 1.0;
  const boost::math::hypergeometric_distribution<> tables(
      static_cast<unsigned>(hits), static_cast<unsigned>(first.total), static_cast<unsigned>(total));
  const auto probability = [&](std::int64_t k) { return boost::math::pdf(tables, static_cast<unsigned>(k)); };
  // With two groups of equal size, the mirrored table has the same probability only to within rounding.
  const double found = probability(first.hits) * (1.0 + 1e-9);
  double p = 0.0;
  for (std::int64_t k = std::max<std::int64_t>(0, hits - second.total); k <= std::min(hits, first.total); ++k)
    if (const double each = probability(k); each <= found)
      p += each;
  return std::min(1.0, p);
}

/// Returns the length of the interval divided by the length it would have for independent trials.
double stretch_of(const Rate& rate, double confidence) {
  const Interval independent = wilson_interval(rate.hits, rate.total, confidence);
  return (rate.interval.upper - rate.interval.lower) / (independent.upper - independent.lower);
}

/// Returns p of two shares of which at least one has clusters. Each variance is as many times larger as the
/// square of the stretch of its interval. 0 if neither interval is longer than that of independent trials.
double clustered_p(const Rate& first, const Rate& second, double confidence) {
  const double of_first = stretch_of(first, confidence), of_second = stretch_of(second, confidence);
  if (of_first <= 1.0 && of_second <= 1.0)
    return 0.0;
  const double pooled =
      static_cast<double>(first.hits + second.hits) / static_cast<double>(first.total + second.total);
  const double variance = pooled * (1.0 - pooled) *
                          (of_first * of_first / static_cast<double>(first.total) +
                           of_second * of_second / static_cast<double>(second.total));
  if (variance == 0.0)
    return 1.0;
  return std::erfc(std::abs(second.value - first.value) / std::sqrt(2.0 * variance));
}

void require_counts(const PairedCounts& counts) {
  for (const std::int64_t count : {counts.both, counts.first, counts.second, counts.neither})
    if (count < 0)
      throw InputError("number of cases", fmt::format("{}", count), "0 or more");
}

/// paired_difference() of the shares in `counts`, as if there were `cases` independent cases.
ShareDifference difference_of(const PairedCounts& counts, double cases, const McNemarTest& test,
                              double confidence) {
  const std::int64_t total = counts.total();
  Rate first = rate(counts.both + counts.first, total, confidence);
  Rate second = rate(counts.both + counts.second, total, confidence);
  if (total == 0)
    return {kNaN, {kNaN, kNaN}, kNaN};
  if (cases < static_cast<double>(total))
    for (Rate* const each : {&first, &second})
      each->interval = score_interval(each->value, cases, confidence);
  return {second.value - first.value, combined(first, second, corrected_phi(counts, cases)),
          test.p_two_sided};
}

/// Returns the clusters that have a case.
std::vector<PairedCounts> occupied(std::span<const PairedCounts> clusters) {
  std::vector<PairedCounts> kept;
  for (const PairedCounts& cluster : clusters) {
    require_counts(cluster);
    if (cluster.total() > 0)
      kept.push_back(cluster);
  }
  return kept;
}

}  // namespace

void PairedCounts::add(bool in_first, bool in_second) {
  ++(in_first ? in_second ? both : first : in_second ? second : neither);
}

ShareDifference paired_difference(const PairedCounts& counts, double confidence) {
  require_counts(counts);
  return difference_of(counts, static_cast<double>(counts.total()), mcnemar_test(counts.first, counts.second),
                       confidence);
}

PairedCounts pooled_counts(std::span<const PairedCounts> clusters) {
  PairedCounts sum;
  for (const PairedCounts& cluster : clusters) {
    sum.both += cluster.both;
    sum.first += cluster.first;
    sum.second += cluster.second;
    sum.neither += cluster.neither;
  }
  return sum;
}

namespace {

ShareDifference of_clusters(std::span<const PairedCounts> clusters, double confidence) {
  const std::vector<PairedCounts> kept = occupied(clusters);
  const PairedCounts sum = pooled_counts(kept);
  if (kept.size() < 2)
    return paired_difference(sum, confidence);
  const auto n = static_cast<double>(sum.total()), W = static_cast<double>(kept.size());
  const double D = static_cast<double>(sum.second - sum.first) / n;
  double squares = 0.0;
  for (const PairedCounts& each : kept)
    squares +=
        std::pow(static_cast<double>(each.second - each.first) - D * static_cast<double>(each.total()), 2);
  const double clustered = W / (W - 1.0) * squares / (n * n);
  const double independent = (static_cast<double>(sum.first + sum.second) / n - D * D) / n;
  const double z = two_sided_normal_quantile(confidence);
  const double t = two_sided_student_quantile(confidence, static_cast<std::int64_t>(kept.size()) - 1);
  const double ratio = clustered > 0.0 && independent > 0.0 ? independent / clustered : 1.0;
  return difference_of(sum, n * std::min(1.0, ratio * z * z / (t * t)), clustered_mcnemar(kept), confidence);
}

}  // namespace

ShareDifference clustered_difference(std::span<const PairedCounts> clusters, double confidence,
                                     double further_variance) {
  ShareDifference found = of_clusters(clusters, confidence);
  if (!(further_variance > 0.0) || std::isnan(found.value))
    return found;
  const double z = two_sided_normal_quantile(confidence);
  const double variance =
      std::pow((found.interval.upper - found.interval.lower) / (2.0 * z), 2) + further_variance;
  const auto longer = [&](double half) { return std::sqrt(half * half + z * z * further_variance); };
  found.interval = {std::max(-1.0, found.value - longer(found.value - found.interval.lower)),
                    std::min(1.0, found.value + longer(found.interval.upper - found.value))};
  found.p = std::max(found.p, std::erfc(std::abs(found.value) / std::sqrt(2.0 * variance)));
  return found;
}

McNemarTest clustered_mcnemar(std::span<const PairedCounts> clusters) {
  const std::vector<PairedCounts> kept = occupied(clusters);
  const PairedCounts sum = pooled_counts(kept);
  McNemarTest test = mcnemar_test(sum.first, sum.second);
  if (kept.size() < 2)
    return test;
  const auto W = static_cast<double>(kept.size());
  const double mean = static_cast<double>(sum.first - sum.second) / W;
  double squares = 0.0;
  for (const PairedCounts& each : kept)
    squares += std::pow(static_cast<double>(each.first - each.second) - mean, 2);
  if (squares == 0.0)
    return test;
  const double t = W * mean / std::sqrt(W / (W - 1.0) * squares);
  const auto freedom = static_cast<std::int64_t>(kept.size()) - 1;
  test.p_two_sided = std::max(test.p_two_sided, 2.0 * student_upper_tail(std::abs(t), freedom));
  test.p_worse = std::max(test.p_worse, student_upper_tail(t, freedom));
  return test;
}

ShareDifference independent_difference(const Rate& first, const Rate& second, double confidence) {
  const auto of = [confidence](const Rate& rate) {
    return rate.clusters.empty() ? mpm::rate(rate.hits, rate.total, confidence)
                                 : clustered_rate(rate.clusters, confidence, rate.further_variance);
  };
  const Rate a = of(first), b = of(second);
  if (a.total == 0 || b.total == 0)
    return {kNaN, {kNaN, kNaN}, kNaN};
  return {b.value - a.value, combined(a, b, 0.0), std::max(fisher_p(a, b), clustered_p(a, b, confidence))};
}

}  // namespace mpm
