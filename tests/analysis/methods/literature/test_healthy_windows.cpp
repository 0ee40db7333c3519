#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/methods/literature/healthy_windows.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

using testing::settled_autoregression;

constexpr WindowRule kRule{.window = 240, .step = 60};

/// A period with two filters of an input of its own, and noise of deviation `size`.
PlantAndNoise long_period(double a, std::uint64_t number, const Eigen::Vector2d& b = Eigen::Vector2d::Zero(),
                          double size = 1.0, Eigen::Index samples = 1440) {
  const Eigen::VectorXd input = settled_autoregression(samples, 0.9, 2 * number + 1);
  Eigen::MatrixXd X(samples, 2);
  X.col(0) = filter(Eigen::VectorXd::Constant(1, 0.2), Eigen::Vector2d(1.0, -0.8), input, 1);
  X.col(1) = delayed(input, 2, StartState::rest);
  return {size * settled_autoregression(samples, a, 2 * number) + X * b, X};
}

}  // namespace

TEST_CASE("healthy windows: a healthy record is inside, a changed plant or noise model is outside") {
  const HealthyWindows healthy(long_period(0.5, 95001), kRule);
  const auto check = [&](const PlantAndNoise& record, bool plant, bool noise) {
    const HealthyWindows::Outside of = healthy.outside(record);
    INFO(of.plant << ", " << of.noise);
    CHECK((of.plant > 0.0) == plant);
    CHECK((of.noise > 0.0) == noise);
  };
  check(long_period(0.5, 95002), false, false);
  check(long_period(0.5, 95003, {0.5, 0.3}), true, false);
  check(long_period(0.9, 95004), false, true);
  check(long_period(0.5, 95005, {0.0, 0.0}, 2.0), false, true);
  check(long_period(0.9, 95006, {1.0, 0.6}), true, true);
}

TEST_CASE("healthy windows: few of many healthy records lie outside") {
  int outside = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    const HealthyWindows healthy(long_period(0.8, 96000 + trial), kRule);
    const HealthyWindows::Outside of = healthy.outside(long_period(0.8, 97000 + trial));
    outside += of.plant > 0.0 || of.noise > 0.0 ? 1 : 0;
  }
  // A window is outside with a probability of about nu; that half of the 21 of a record are is rarer still.
  CHECK(outside <= 1);
}

TEST_CASE("healthy windows: the share says how many windows must be outside") {
  // The plant changes in the last quarter of the record, which 6 of the 21 windows reach.
  PlantAndNoise record = long_period(0.5, 95052);
  record.e.tail(360) += record.X.bottomRows(360) * Eigen::Vector2d(0.8, 0.5);
  WindowRule rule = kRule;
  CHECK(HealthyWindows(long_period(0.5, 95051), rule).outside(record).plant < 0.0);
  rule.share = 0.2;
  CHECK(HealthyWindows(long_period(0.5, 95051), rule).outside(record).plant > 0.0);
}

TEST_CASE("healthy windows: an input that stands still in some windows, and none at all, are no mismatch") {
  PlantAndNoise record = long_period(0.5, 95022);
  record.X.topRows(480).col(1).setConstant(record.X(480, 1));
  CHECK(HealthyWindows(long_period(0.5, 95021), kRule).outside(record).plant < 0.0);
  const auto without = [](PlantAndNoise period) {
    period.X.resize(period.e.size(), 0);
    return period;
  };
  CHECK(HealthyWindows(without(long_period(0.5, 95023)), kRule).outside(without(record)).plant == -kInfinity);
}

TEST_CASE("healthy windows: a period or record without a window is refused") {
  CHECK_THROWS_WITH(HealthyWindows(long_period(0.5, 95031, {0.0, 0.0}, 1.0, 240), kRule),
                    Catch::Contains("more than a window of 240"));
  CHECK_THROWS_AS(
      HealthyWindows(long_period(0.5, 95032), kRule).outside(long_period(0.5, 95033, {0.0, 0.0}, 1.0, 239)),
      InputError);
}

}  // namespace mpm
