#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/clustered_rate.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

/// Clusters whose probability is uniform on [mean - spread, mean + spread].
std::vector<ClusterCount> drawn(int clusters, int trials, double mean, double spread, RandomStream& stream) {
  std::vector<ClusterCount> counts;
  for (int cluster = 0; cluster < clusters; ++cluster) {
    const double p = mean + spread * (2.0 * stream.uniform() - 1.0);
    ClusterCount count;
    for (int trial = 0; trial < trials; ++trial, ++count.total)
      count.hits += stream.uniform() < p ? 1 : 0;
    counts.push_back(count);
  }
  return counts;
}

}  // namespace

TEST_CASE("clustered rate: of one cluster, or without scatter, it is Wilson's of fewer trials at most",
          "[clustered_rate]") {
  const std::vector<ClusterCount> one{{}, {7, 20}};
  CHECK(clustered_rate(one).interval.lower == rate(7, 20).interval.lower);
  CHECK(clustered_rate(std::vector<ClusterCount>{}).total == 0);
  const std::vector<ClusterCount> none{{0, 10}, {0, 10}, {0, 10}};
  const Rate zero = clustered_rate(none);
  CHECK(zero.value == 0.0);
  CHECK(zero.interval.lower == 0.0);
  CHECK(zero.interval.upper > rate(0, 30).interval.upper);  // Student's quantile with 2 degrees of freedom
  const std::vector<ClusterCount> apart{{0, 10}, {10, 10}, {0, 10}, {10, 10}};
  const Rate wide = clustered_rate(apart);
  CHECK(wide.value == 0.5);
  CHECK(wide.hits == 20);
  CHECK(wide.total == 40);
  const Interval independent = rate(20, 40).interval;
  CHECK(wide.interval.upper - wide.interval.lower > 1.5 * (independent.upper - independent.lower));
  CHECK(wide.clusters.size() == 4);
  CHECK_THROWS(clustered_rate(apart, 1.0));
}

TEST_CASE("clustered rate: strata that differ add no variance of their own", "[clustered_rate]") {
  const std::vector<std::vector<ClusterCount>> strata{{{1, 10}, {1, 10}, {2, 10}},
                                                      {{9, 10}, {9, 10}, {8, 10}}};
  const Rate stratified = clustered_rate(strata);
  const Rate pooled =
      clustered_rate(std::vector<ClusterCount>{{1, 10}, {1, 10}, {2, 10}, {9, 10}, {9, 10}, {8, 10}});
  CHECK(stratified.value == pooled.value);
  CHECK(stratified.interval.upper - stratified.interval.lower <
        0.6 * (pooled.interval.upper - pooled.interval.lower));
  // A stratum of one cluster counts as independent trials, and all such ones as rate().
  const std::vector<std::vector<ClusterCount>> single{{{3, 10}}, {{7, 10}}};
  CHECK(clustered_rate(single).interval.lower == rate(10, 20).interval.lower);
}

TEST_CASE("clustered mean: of zeros and ones it is the clustered rate, and of nothing there is none",
          "[clustered_rate]") {
  const std::vector<std::vector<ClusterCount>> counts{{{7, 10}, {2, 9}, {5, 5}}, {{1, 4}, {3, 3}}};
  std::vector<std::vector<ClusterSum>> sums;
  for (const std::vector<ClusterCount>& stratum : counts) {
    sums.emplace_back();
    for (const ClusterCount& count : stratum)
      sums.back().push_back({static_cast<double>(count.hits), count.total});
  }
  const Rate share = clustered_rate(counts);
  const Estimate mean = clustered_mean(sums);
  CHECK(mean.value == share.value);
  CHECK(mean.count == share.total);
  CHECK(mean.interval.lower == share.interval.lower);
  CHECK(mean.interval.upper == share.interval.upper);
  CHECK(std::isnan(clustered_mean(std::vector<ClusterSum>{}).value));
  CHECK(clustered_mean(std::vector<ClusterSum>{{0.5, 2}, {1.5, 2}}).clusters.size() == 2);
  CHECK_THROWS(clustered_mean(std::vector<ClusterSum>{{2.5, 2}}));
  CHECK_THROWS(clustered_mean(std::vector<ClusterSum>{{-0.5, 2}}));
}

TEST_CASE(
    "clustered rate: its intervals hold the truth in 93 to 98 % of 500 suites of eight worlds, where those "
    "of "
    "independent trials hold it in fewer",
    "[clustered_rate]") {
  RandomStream stream(20261125, 0, StreamId::bootstrap);
  for (const auto& [mean, spread] : {std::pair(0.5, 0.3), {0.85, 0.15}, {0.2, 0.2}}) {
    int held = 0, held_by_independent = 0;
    for (int suite = 0; suite < 500; ++suite) {
      const std::vector<ClusterCount> counts = drawn(8, 40, mean, spread, stream);
      const Rate clustered = clustered_rate(counts);
      held += clustered.interval.contains(mean) ? 1 : 0;
      held_by_independent += rate(clustered.hits, clustered.total).interval.contains(mean) ? 1 : 0;
    }
    INFO(mean << " +- " << spread << ": " << held << " and " << held_by_independent << " of 500");
    // 95 % are meant; a share of 500 has a standard error of 1 %. Wilson's interval of few trials is wide.
    CHECK(held >= 465);
    CHECK(held <= 490);
    CHECK(held_by_independent < held);
  }
}

}  // namespace mpm
