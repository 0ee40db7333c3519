#include "analysis/statistics/clustered_rate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <boost/math/distributions/students_t.hpp>

namespace mpm {
namespace {

struct Totals {
  std::int64_t hits = 0, total = 0, occupied = 0;  ///< clusters with a trial

  double share() const { return static_cast<double>(hits) / static_cast<double>(total); }
};

Totals totals_of(const std::vector<ClusterCount>& clusters) {
  Totals sum;
  for (const ClusterCount& cluster : clusters) {
    sum.hits += cluster.hits;
    sum.total += cluster.total;
    sum.occupied += cluster.total > 0 ? 1 : 0;
  }
  return sum;
}

/// The variance of the number of hits in a stratum.
double variance_of_hits(const std::vector<ClusterCount>& clusters, const Totals& sum) {
  const double p = sum.share();
  if (sum.occupied < 2)
    return p * (1.0 - p) * static_cast<double>(sum.total);
  double squares = 0.0;
  for (const ClusterCount& cluster : clusters)
    squares += std::pow(static_cast<double>(cluster.hits) - p * static_cast<double>(cluster.total), 2);
  const auto W = static_cast<double>(sum.occupied);
  return W / (W - 1.0) * squares;
}

}  // namespace

Rate clustered_rate(std::span<const std::vector<ClusterCount>> strata, double confidence) {
  std::int64_t hits = 0, total = 0, freedom = 0;
  double variance = 0.0;
  for (const std::vector<ClusterCount>& clusters : strata) {
    const Totals sum = totals_of(clusters);
    if (sum.total == 0)
      continue;
    hits += sum.hits;
    total += sum.total;
    freedom += sum.occupied - 1;
    variance += variance_of_hits(clusters, sum);
  }
  Rate all = rate(hits, total, confidence);
  if (freedom == 0)
    return all;
  const auto n = static_cast<double>(total);
  const double t = boost::math::quantile(boost::math::complement(
      boost::math::students_t(static_cast<double>(freedom)), (1.0 - confidence) / 2.0));
  const double z = two_sided_normal_quantile(confidence);
  const double independent = variance > 0.0 ? all.value * (1.0 - all.value) * n * n / variance : n;
  all.interval = score_interval(all.value, std::min(n, independent * z * z / (t * t)), confidence);
  return all;
}

Rate clustered_rate(std::vector<ClusterCount> clusters, double confidence) {
  Rate all = clustered_rate(std::span(&clusters, 1), confidence);
  all.clusters = std::move(clusters);
  return all;
}

}  // namespace mpm
