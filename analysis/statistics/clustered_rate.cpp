#include "analysis/statistics/clustered_rate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/student.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

struct Totals {
  double sum = 0.0;
  std::int64_t count = 0, occupied = 0;  ///< trials, and clusters that have any

  double share() const { return sum / static_cast<double>(count); }
};

Totals totals_of(const std::vector<ClusterSum>& clusters) {
  Totals all;
  for (const ClusterSum& cluster : clusters) {
    all.sum += cluster.sum;
    all.count += cluster.count;
    all.occupied += cluster.count > 0 ? 1 : 0;
  }
  return all;
}

/// The variance of the number of hits in a stratum.
double variance_of_hits(const std::vector<ClusterSum>& clusters, const Totals& all) {
  const double p = all.share();
  if (all.occupied < 2)
    return p * (1.0 - p) * static_cast<double>(all.count);
  double squares = 0.0;
  for (const ClusterSum& cluster : clusters)
    squares += std::pow(cluster.sum - p * static_cast<double>(cluster.count), 2);
  const auto W = static_cast<double>(all.occupied);
  return W / (W - 1.0) * squares;
}

std::vector<ClusterSum> sums_of(const std::vector<ClusterCount>& clusters) {
  std::vector<ClusterSum> sums;
  for (const ClusterCount& cluster : clusters)
    sums.push_back({static_cast<double>(cluster.hits), cluster.total});
  return sums;
}

void require_sums(std::span<const std::vector<ClusterSum>> strata) {
  for (const std::vector<ClusterSum>& clusters : strata)
    for (const ClusterSum& cluster : clusters)
      if (!(cluster.sum >= 0.0 && cluster.sum <= static_cast<double>(cluster.count)))
        throw InputError("sum of a cluster", fmt::format("{}", cluster.sum),
                         fmt::format("0 to {}, the number of its values", cluster.count));
}

}  // namespace

namespace {

/// clustered_mean() with a `further` variance of the mean, as in clustered_rate().
Estimate mean_with(std::span<const std::vector<ClusterSum>> strata, double confidence, double further) {
  require_sums(strata);
  double hits = 0.0, variance = 0.0;
  std::int64_t total = 0, freedom = 0;
  for (const std::vector<ClusterSum>& clusters : strata) {
    const Totals all = totals_of(clusters);
    if (all.count == 0)
      continue;
    hits += all.sum;
    total += all.count;
    freedom += all.occupied - 1;
    variance += variance_of_hits(clusters, all);
  }
  const double z = two_sided_normal_quantile(confidence);
  if (total == 0)
    return {};
  const auto n = static_cast<double>(total);
  Estimate mean{.value = hits / n, .count = total};
  double trials = n;
  if (freedom > 0) {
    const double t = two_sided_student_quantile(confidence, freedom);
    const double p = further > 0.0 ? (hits + 0.5) / (n + 1.0) : mean.value;
    variance += further * n * n;
    const double independent = variance > 0.0 ? p * (1.0 - p) * n * n / variance : n;
    trials = std::min(n, independent * z * z / (t * t));
  }
  mean.interval = score_interval(mean.value, trials, confidence);
  return mean;
}

}  // namespace

Estimate clustered_mean(std::span<const std::vector<ClusterSum>> strata, double confidence) {
  return mean_with(strata, confidence, 0.0);
}

Rate clustered_rate(std::span<const std::vector<ClusterCount>> strata, double confidence,
                    double further_variance) {
  std::int64_t hits = 0, total = 0;
  bool several = false;
  std::vector<std::vector<ClusterSum>> sums;
  for (const std::vector<ClusterCount>& clusters : strata) {
    const auto occupied = [](const ClusterCount& cluster) { return cluster.total > 0; };
    several = several || std::count_if(clusters.begin(), clusters.end(), occupied) > 1;
    sums.push_back(sums_of(clusters));
    for (const ClusterCount& cluster : clusters) {
      hits += cluster.hits;
      total += cluster.total;
    }
  }
  Rate all = rate(hits, total, confidence);
  if (several)
    all.interval = mean_with(sums, confidence, further_variance).interval;
  all.further_variance = further_variance;
  return all;
}

Rate clustered_rate(std::vector<ClusterCount> clusters, double confidence, double further_variance) {
  Rate all = clustered_rate(std::span(&clusters, 1), confidence, further_variance);
  all.clusters = std::move(clusters);
  return all;
}

Estimate clustered_mean(std::vector<ClusterSum> clusters, double confidence) {
  Estimate mean = clustered_mean(std::span(&clusters, 1), confidence);
  mean.clusters = std::move(clusters);
  return mean;
}

}  // namespace mpm
