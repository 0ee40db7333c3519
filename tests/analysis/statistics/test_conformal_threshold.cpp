#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/conformal_threshold.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

/// 1 ... count, in an order of no meaning.
std::vector<double> whole_scores(int count) {
  std::vector<double> scores;
  for (int i = 0; i < count; ++i)
    scores.push_back(1.0 + (7 * i) % count);
  return scores;
}

TEST_CASE("conformal threshold: the ceil((n + 1)(1 - a))-th smallest score", "[conformal]") {
  CHECK(conformal_threshold(whole_scores(19), 0.05) == 19.0);
  CHECK(conformal_threshold(whole_scores(39), 0.05) == 38.0);
  CHECK(conformal_threshold(whole_scores(40), 0.05) == 39.0);  // ceil(38.95)
  CHECK(conformal_threshold(whole_scores(200), 0.05) == 191.0);
  CHECK(conformal_threshold(whole_scores(99), 0.01) == 99.0);
  CHECK(conformal_threshold(whole_scores(10), 0.5) == 6.0);
}

TEST_CASE("conformal threshold: none of too few scores, and what is too few", "[conformal]") {
  CHECK(fewest_scores(0.05) == 19);
  CHECK(fewest_scores(0.01) == 99);
  CHECK(fewest_scores(0.5) == 1);
  CHECK(fewest_scores(0.9) == 1);
  for (const double false_alarms : {0.003, 0.01, 0.03, 0.05, 0.1, 0.3, 0.7}) {
    INFO(false_alarms);
    const auto fewest = static_cast<std::size_t>(fewest_scores(false_alarms));
    CHECK(conformal_threshold(std::vector<double>(fewest, 1.0), false_alarms).has_value());
    CHECK_FALSE(conformal_threshold(std::vector<double>(fewest - 1, 1.0), false_alarms).has_value());
  }
  CHECK_FALSE(conformal_threshold({}, 0.5).has_value());
}

TEST_CASE("conformal threshold: a score that is NaN is below all others", "[conformal]") {
  std::vector<double> scores = whole_scores(19);
  scores.push_back(kNaN);
  CHECK(conformal_threshold(scores, 0.1) == 18.0);  // 20 scores, the 19th of them
  CHECK(conformal_threshold(std::vector<double>(19, kNaN), 0.05) == -kInfinity);
}

TEST_CASE("conformal threshold: a rate outside of 0 to 1 is refused", "[conformal]") {
  for (const double rate : {0.0, 1.0, -0.1, kNaN}) {
    CHECK_THROWS_AS(conformal_threshold(whole_scores(9), rate), InputError);
    CHECK_THROWS_AS(fewest_scores(rate), InputError);
  }
}

TEST_CASE("conformal threshold: a further score is above it as often as is said", "[conformal]") {
  // Scores without ties: exactly floor((n + 1) a)/(n + 1) = 2/50 on average over n scores and the further
  // one.
  constexpr int kTrials = 20000;
  RandomStream stream(5, 6, StreamId::measurement_noise);
  std::int64_t above = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> scores(49);
    for (double& score : scores)
      score = std::exp(3.0 * stream.normal());
    above += std::exp(3.0 * stream.normal()) > *conformal_threshold(scores, 0.05) ? 1 : 0;
  }
  const double share = static_cast<double>(above) / kTrials;
  CHECK(share == Approx(0.04).margin(0.0056));  // four standard errors of a share of 20000
}

}  // namespace
}  // namespace mpm
