#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/statistics/share_difference.hpp"
#include "plants/error.hpp"
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
