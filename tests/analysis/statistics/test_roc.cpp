#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/roc.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

/// Scores on a grid, so that there are ties within and between the two sides.
std::vector<double> scores_on_a_grid(RandomStream& stream, int count, double shift) {
  std::vector<double> scores;
  for (int i = 0; i < count; ++i)
    scores.push_back(std::round(4.0 * (stream.normal() + shift)) / 4.0);
  return scores;
}

std::vector<RocPoint> points_of(const RocCurve& curve) {
  std::vector<RocPoint> points;
  curve.each([&](const RocPoint& point) { points.push_back(point); });
  CHECK(points.size() == curve.size);
  return points;
}

/// The area as the share of pairs in which the positive wins, counted pair by pair.
double mann_whitney(const std::vector<double>& positives, const std::vector<double>& negatives) {
  double wins = 0.0;
  for (const double p : positives)
    for (const double n : negatives)
      wins += p > n ? 1.0 : p == n ? 0.5 : 0.0;
  return wins / static_cast<double>(positives.size() * negatives.size());
}

TEST_CASE("roc: the area is the share of pairs in which the positive scores higher, ties half") {
  RandomStream stream(11, 0, StreamId::bootstrap);
  for (int trial = 0; trial < 50; ++trial) {
    const auto positives = scores_on_a_grid(stream, 1 + trial, 0.7);
    const auto negatives = scores_on_a_grid(stream, 60 - trial, 0.0);
    const RocCurve curve = roc_curve(positives, negatives);
    // A sum of at most 60 products of numbers below 1.
    CHECK(curve.area == Approx(mann_whitney(positives, negatives)).margin(1e-13));
    CHECK(roc_curve(negatives, positives).area == Approx(1.0 - curve.area).margin(1e-13));
  }
}

TEST_CASE("roc: the curve rises from nothing to everything, and each point is what its threshold does") {
  RandomStream stream(12, 0, StreamId::bootstrap);
  const auto positives = scores_on_a_grid(stream, 40, 1.0);
  const auto negatives = scores_on_a_grid(stream, 50, 0.0);
  const RocCurve curve = roc_curve(positives, negatives);
  const std::vector<RocPoint> points = points_of(curve);
  CHECK(points.front().true_positive_rate == 0.0);
  CHECK(points.front().false_positive_rate == 0.0);
  CHECK(std::isnan(points.front().precision));
  CHECK(points.back().true_positive_rate == 1.0);
  CHECK(points.back().false_positive_rate == 1.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RocPoint& point = points[i];
    const RocPoint again = roc_point(positives, negatives, point.threshold);
    CHECK(again.true_positive_rate == point.true_positive_rate);
    CHECK(again.false_positive_rate == point.false_positive_rate);
    CHECK((again.precision == point.precision || (std::isnan(again.precision) && i == 0)));
    CHECK(point.youden() <= curve.best.youden());
    if (i > 0) {
      CHECK(point.threshold < points[i - 1].threshold);
      CHECK(point.true_positive_rate >= points[i - 1].true_positive_rate);
      CHECK(point.false_positive_rate >= points[i - 1].false_positive_rate);
    }
  }
}

TEST_CASE("roc: of scores in several lists it is the curve of all of them") {
  RandomStream stream(14, 0, StreamId::bootstrap);
  const auto one = scores_on_a_grid(stream, 20, 1.0), other = scores_on_a_grid(stream, 30, 0.5);
  const auto negatives = scores_on_a_grid(stream, 40, 0.0);
  std::vector<double> both = one;
  both.insert(both.end(), other.begin(), other.end());
  const std::vector<RocPoint> expected = points_of(roc_curve(both, negatives));
  const RocCurve curve = roc_curve({SortedScores(one), SortedScores(other)}, {SortedScores(negatives)});
  const std::vector<RocPoint> points = points_of(curve);
  REQUIRE(points.size() == expected.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points[i].threshold == expected[i].threshold);
    CHECK(points[i].true_positive_rate == expected[i].true_positive_rate);
    CHECK(points[i].false_positive_rate == expected[i].false_positive_rate);
  }
  CHECK(curve.area == roc_curve(both, negatives).area);
}

TEST_CASE("roc: an increasing transformation of the scores changes thresholds only") {
  RandomStream stream(13, 0, StreamId::bootstrap);
  auto positives = scores_on_a_grid(stream, 30, 0.5);
  auto negatives = scores_on_a_grid(stream, 30, 0.0);
  const RocCurve before = roc_curve(positives, negatives);
  for (auto* scores : {&positives, &negatives})
    for (double& score : *scores)
      score = std::exp(score);
  const RocCurve after = roc_curve(positives, negatives);
  CHECK(after.area == before.area);
  CHECK(after.average_precision == before.average_precision);
  CHECK(after.best.true_positive_rate == before.best.true_positive_rate);
  CHECK(after.best.false_positive_rate == before.best.false_positive_rate);
}

TEST_CASE("roc: separated scores, equal scores and a curve known by hand") {
  const RocCurve separated = roc_curve(std::vector{3.0, 4.0}, std::vector{1.0, 2.0});
  CHECK(separated.area == 1.0);
  CHECK(separated.average_precision == 1.0);
  CHECK(separated.best.threshold == 2.5);
  CHECK(separated.best.youden() == 1.0);

  const RocCurve equal = roc_curve(std::vector{1.0, 1.0}, std::vector{1.0});
  CHECK(equal.area == 0.5);
  CHECK(equal.size == 2);
  CHECK(std::isinf(equal.best.threshold));  // no threshold is better than none

  // 3 (+), 2 (-), 1 (+): recall 1/2 at precision 1, recall 1 at precision 2/3.
  const RocCurve mixed = roc_curve(std::vector{3.0, 1.0}, std::vector{2.0});
  CHECK(mixed.area == 0.5);
  CHECK(mixed.average_precision == Approx(0.5 * 1.0 + 0.5 * 2.0 / 3.0));
}

TEST_CASE("roc: NaNs are left out; without a side there is no curve") {
  const RocCurve curve = roc_curve(std::vector{mpm::kNaN, 2.0}, std::vector{1.0, mpm::kNaN, mpm::kNaN});
  CHECK(curve.positives == 1);
  CHECK(curve.negatives == 1);
  CHECK(curve.left_out == 3);
  CHECK(curve.area == 1.0);
  const RocCurve none = roc_curve(std::vector{1.0}, std::vector{mpm::kNaN});
  CHECK_FALSE(none.defined());
  CHECK(std::isnan(none.area));
  CHECK(points_of(none).empty());
}

TEST_CASE("roc: each end of the interval of an area solves its equation") {
  const double z = two_sided_normal_quantile(0.95);
  for (const double area : {0.02, 0.5, 0.758, 0.99}) {
    const Interval interval = area_interval(area, 71, 93);
    CHECK(interval.contains(area));
    for (const double a : {interval.lower, interval.upper}) {
      const double others = 0.5 * (71 + 93) - 1.0;
      const double variance = a * (1 - a) / (71.0 * 93.0) * (1 + others * ((1 - a) / (2 - a) + a / (1 + a)));
      // The end is found to its last bit; 1e-12 leaves room for the rounding of the equation.
      CHECK(std::abs(a - area) == Approx(z * std::sqrt(variance)).margin(1e-12));
    }
  }
  const Interval perfect = area_interval(1.0, 20, 20);
  CHECK(perfect.upper == 1.0);
  CHECK(perfect.lower < 0.95);
  CHECK(perfect.lower > 0.7);
}

TEST_CASE("roc: the interval of an area covers the truth about as often as it says") {
  RandomStream stream(14, 0, StreamId::bootstrap);
  constexpr int kTrials = 1000;
  for (const double shift : {0.0, 1.0, 2.0}) {
    const double truth = 0.5 * std::erfc(-shift / 2.0);  // P(N(shift, 1) > N(0, 1))
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> positives, negatives;
      for (int i = 0; i < 30; ++i) {
        positives.push_back(stream.normal() + shift);
        negatives.push_back(stream.normal());
      }
      covered += area_interval(roc_curve(positives, negatives).area, 30, 30).contains(truth) ? 1 : 0;
    }
    // 1000 trials know a coverage of 95 % to +-2 % (three standard deviations); the method is approximate.
    CHECK(covered > 0.92 * kTrials);
    CHECK(covered < 0.99 * kTrials);
  }
}

TEST_CASE("roc: the interval of the best threshold lies around the crossing of the densities") {
  RandomStream data(15, 0, StreamId::bootstrap);
  std::vector<double> positives, negatives;
  for (int i = 0; i < 300; ++i) {
    positives.push_back(data.normal() + 3.0);
    negatives.push_back(data.normal());
  }
  RandomStream stream(16, 0, StreamId::bootstrap);
  const Interval interval = best_threshold_interval(positives, negatives, stream);
  CHECK(interval.contains(1.5));  // where the densities of N(0, 1) and N(3, 1) cross
  CHECK(interval.upper - interval.lower < 1.5);
  RandomStream same(16, 0, StreamId::bootstrap);
  CHECK(best_threshold_interval(positives, negatives, same).lower == interval.lower);

  const Interval one = best_threshold_interval(std::vector{3.0}, std::vector{1.0}, stream);
  CHECK(one.lower == 2.0);
  CHECK(one.upper == 2.0);
  CHECK(std::isnan(best_threshold_interval(std::vector{1.0}, {}, stream).lower));
  CHECK(std::isnan(best_threshold_interval(std::vector{1.0}, std::vector{1.0}, stream).lower));
}

TEST_CASE("roc: wrong input is refused by name") {
  RandomStream stream(17, 0, StreamId::bootstrap);
  CHECK_THROWS_WITH(area_interval(1.5, 3, 3), Contains("area under the curve") && Contains("1.5"));
  CHECK_THROWS_WITH(area_interval(0.5, 0, 3), Contains("positives and negatives") && Contains("0 and 3"));
  CHECK_THROWS_AS(area_interval(0.5, 3, 3, 1.0), InputError);
  CHECK_THROWS_WITH(best_threshold_interval(std::vector{1.0}, std::vector{0.0}, stream, {99, 0.95}),
                    Contains("bootstrap replications") && Contains("99"));
  CHECK_THROWS_AS(best_threshold_interval(std::vector{1.0}, std::vector{0.0}, stream, {100, 0.0}),
                  InputError);
}

}  // namespace
