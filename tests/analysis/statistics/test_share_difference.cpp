#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/clustered_rate.hpp"
#include "analysis/statistics/mcnemar.hpp"
#include "analysis/statistics/share_difference.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"

namespace {

using namespace mpm;

TEST_CASE("share difference: independent shares have the interval of Newcombe's first example") {
  // 56/70 against 48/80: method 10 in table II of the paper gives 0.0524 to 0.3339.
  const ShareDifference found = independent_difference(rate(48, 80), rate(56, 70));
  CHECK(found.value == Approx(0.2));
  CHECK(found.interval.lower == Approx(0.0524).margin(5e-5));
  CHECK(found.interval.upper == Approx(0.3339).margin(5e-5));
}

TEST_CASE("share difference: Fisher's p of the lady tasting tea, and of tables nobody can tell apart") {
  // 3 of 4 against 1 of 4: P(0) + P(1) + P(3) + P(4) of C(4, k)^2 / 70, all but the 36 of k = 2.
  CHECK(independent_difference(rate(3, 4), rate(1, 4)).p == Approx(34.0 / 70.0));
  CHECK(independent_difference(rate(4, 4), rate(0, 4)).p == Approx(2.0 / 70.0));
  CHECK(independent_difference(rate(2, 4), rate(2, 4)).p == Approx(1.0));
  CHECK(independent_difference(rate(0, 4), rate(0, 9)).p == 1.0);
}

TEST_CASE("share difference: what is swapped changes its sign and nothing else") {
  const PairedCounts counts{11, 7, 2, 13}, swapped{11, 2, 7, 13};
  const ShareDifference there = paired_difference(counts), back = paired_difference(swapped);
  CHECK(there.value == Approx(-5.0 / 33.0));
  CHECK(back.value == Approx(-there.value));
  CHECK(back.interval.lower == Approx(-there.interval.upper));
  CHECK(back.interval.upper == Approx(-there.interval.lower));
  CHECK(back.p == there.p);
  // Two-sided p of 7 against 2 coins: 2 (36 + 9 + 1) / 512.
  CHECK(there.p == Approx(92.0 / 512.0));
}

TEST_CASE("share difference: pairs that agree more give a shorter interval than strangers") {
  const ShareDifference paired = paired_difference({40, 3, 8, 49});
  const ShareDifference strangers = independent_difference(rate(43, 100), rate(48, 100));
  CHECK(paired.value == Approx(strangers.value));
  CHECK(paired.interval.lower > strangers.interval.lower + 0.05);
  CHECK(paired.interval.upper < strangers.interval.upper - 0.05);
  // The same where nothing ties the answers together, up to the correction: X = 0.
  const ShareDifference untied = paired_difference({25, 25, 25, 25});
  const ShareDifference loose = independent_difference(rate(50, 100), rate(50, 100));
  CHECK(untied.interval.lower == Approx(loose.interval.lower));
  CHECK(untied.interval.upper == Approx(loose.interval.upper));
}

TEST_CASE("share difference: intervals stay within -1 and 1 and have a length") {
  for (int both = 0; both <= 6; ++both)
    for (int first = 0; first <= 6; ++first)
      for (int second = 0; second <= 6; ++second)
        for (int neither = 0; neither <= 6; ++neither) {
          const PairedCounts counts{both, first, second, neither};
          if (counts.total() == 0)
            continue;
          const ShareDifference found = paired_difference(counts);
          INFO(both << ' ' << first << ' ' << second << ' ' << neither);
          CHECK(found.interval.lower >= -1.0 - 1e-12);  // rounding
          CHECK(found.interval.upper <= 1.0 + 1e-12);
          CHECK(found.interval.lower < found.interval.upper);
          CHECK(found.interval.lower <= found.value);
          CHECK(found.value <= found.interval.upper);
        }
}

TEST_CASE("share difference: the paired interval holds the true difference as often as it says") {
  // 60 cases of which 70 % count the first time; of these 90 % count again, and 25 % of the others do.
  constexpr double kFirst = 0.7, kAgain = 0.9, kNew = 0.25;
  constexpr double kTruth = kFirst * kAgain + (1.0 - kFirst) * kNew - kFirst;
  constexpr int kTrials = 4000;
  RandomStream stream(20261, 0, StreamId::bootstrap);
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    PairedCounts counts;
    for (int i = 0; i < 60; ++i) {
      const bool first = stream.uniform() < kFirst;
      counts.add(first, stream.uniform() < (first ? kAgain : kNew));
    }
    held += paired_difference(counts).interval.contains(kTruth) ? 1 : 0;
  }
  // Newcombe finds 0.93 to 0.97 for most truths; three standard errors of 4000 trials are 0.01.
  CHECK(held > 0.93 * kTrials);
  CHECK(held < 0.98 * kTrials);
}

/// Cases in worlds in which the shares of both times are drawn around their means, partly together.
std::vector<PairedCounts> drawn_worlds(int worlds, int cases, double first, double second, double spread,
                                       double common, RandomStream& stream) {
  std::vector<PairedCounts> counts(static_cast<std::size_t>(worlds));
  for (PairedCounts& world : counts) {
    const double a = 2.0 * stream.uniform() - 1.0, b = 2.0 * stream.uniform() - 1.0;
    const double p = first + spread * a, q = second + spread * (common * a + (1.0 - common) * b);
    for (int i = 0; i < cases; ++i) {
      const double u = stream.uniform(), v = stream.uniform(), w = stream.uniform();
      world.add(u < p, (w < 0.5 ? u : v) < q);
    }
  }
  return counts;
}

TEST_CASE(
    "share difference: of one cluster, or of clusters without scatter, it is that of independent cases") {
  const PairedCounts one{11, 7, 2, 13};
  const std::vector<PairedCounts> alone{{}, one, {}};
  const ShareDifference paired = paired_difference(one), single = clustered_difference(alone);
  CHECK(single.value == paired.value);
  CHECK(single.interval.lower == paired.interval.lower);
  CHECK(single.interval.upper == paired.interval.upper);
  CHECK(single.p == paired.p);
  CHECK(clustered_mcnemar(alone).p_worse == mcnemar_test(7, 2).p_worse);
  // Five worlds that are alike: Student's quantile of 4 degrees of freedom, and nothing else.
  const std::vector<PairedCounts> alike(5, one);
  const ShareDifference five = clustered_difference(alike), pooled = paired_difference(pooled_counts(alike));
  CHECK(five.value == pooled.value);
  CHECK(five.p == pooled.p);
  const double longer =
      (five.interval.upper - five.interval.lower) / (pooled.interval.upper - pooled.interval.lower);
  CHECK(longer == Approx(2.776 / 1.960).epsilon(0.05));
  CHECK_THROWS(clustered_difference(std::vector<PairedCounts>{{1, -1, 0, 0}, one}));
}

TEST_CASE("share difference: McNemar's test of worlds is that of Student on their differences") {
  // Differences lost - gained of 5, 3, 4, 0: mean 3, variance 14/3, t = 3 / sqrt(14/3/4) = 2.777; with 3
  // degrees of freedom P(T > 2.777) = 0.0346.
  const std::vector<PairedCounts> worlds{{10, 5, 0, 5}, {10, 3, 0, 7}, {10, 5, 1, 4}, {10, 1, 1, 8}};
  const McNemarTest test = clustered_mcnemar(worlds);
  CHECK(test.lost == 14);
  CHECK(test.gained == 2);
  CHECK(test.p_worse == Approx(0.0346).margin(2e-4));
  CHECK(test.p_two_sided == Approx(2.0 * 0.0346).margin(4e-4));
  CHECK(test.p_two_sided > mcnemar_test(14, 2).p_two_sided);
}

TEST_CASE(
    "share difference: in 500 suites of worlds the clustered interval holds the true difference in 93 to 97 "
    "%, "
    "that of independent cases in fewer, and the test of no difference rejects in 7 % at most") {
  RandomStream stream(20261125, 0, StreamId::bootstrap);
  for (const auto& [first, second, spread, common] :
       {std::tuple(0.5, 0.5, 0.3, 0.5), {0.8, 0.6, 0.15, 0.5}, {0.2, 0.2, 0.2, 0.0}, {0.6, 0.7, 0.25, 0.2}}) {
    int held = 0, held_by_independent = 0, rejected = 0, rejected_by_independent = 0;
    for (int suite = 0; suite < 500; ++suite) {
      const std::vector<PairedCounts> worlds = drawn_worlds(8, 40, first, second, spread, common, stream);
      const ShareDifference clustered = clustered_difference(worlds),
                            independent = paired_difference(pooled_counts(worlds));
      held += clustered.interval.contains(second - first) ? 1 : 0;
      held_by_independent += independent.interval.contains(second - first) ? 1 : 0;
      rejected += clustered.p < 0.05 ? 1 : 0;
      rejected_by_independent += independent.p < 0.05 ? 1 : 0;
    }
    INFO(first << " and " << second << ": " << held << " and " << held_by_independent << ", rejected "
               << rejected << " and " << rejected_by_independent);
    // 95 % are meant; a share of 500 has a standard error of 1 %.
    CHECK(held >= 465);
    CHECK(held <= 485);
    CHECK(held_by_independent < held);
    if (first == second) {
      CHECK(rejected <= 35);
      CHECK(rejected_by_independent > 50);
    }
  }
}

TEST_CASE("share difference: of different worlds the intervals are those of clusters, and p is not smaller") {
  const std::vector<ClusterCount> few{{0, 10}, {10, 10}, {1, 10}, {9, 10}},
      many{{8, 10}, {9, 10}, {8, 10}, {9, 10}};
  const Rate first = clustered_rate(few), second = clustered_rate(many);
  const ShareDifference clustered = independent_difference(first, second);
  const ShareDifference independent =
      independent_difference(rate(first.hits, first.total), rate(second.hits, second.total));
  CHECK(clustered.value == independent.value);
  CHECK(clustered.interval.lower < independent.interval.lower);
  CHECK(clustered.p > independent.p);
}

TEST_CASE("share difference: nothing is said of no cases, and negative numbers are refused") {
  CHECK(std::isnan(paired_difference({}).value));
  CHECK(std::isnan(paired_difference({}).interval.lower));
  CHECK(std::isnan(independent_difference(rate(0, 0), rate(1, 2)).p));
  CHECK_THROWS_WITH(paired_difference({1, -2, 3, 4}), Catch::Contains("number of cases") &&
                                                          Catch::Contains("-2") &&
                                                          Catch::Contains("0 or more"));
  CHECK_THROWS_AS(paired_difference({1, 2, 3, 4}, 1.0), InputError);
}

}  // namespace
