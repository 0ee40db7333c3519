#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/mismatch_profile.hpp"
#include "base/error.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

const TransferFunction kChannel = TransferFunction::first_order(2.0, 30.0, 10.0);
constexpr double kSampleTime = 4.0;

Eigen::VectorXd steps(Eigen::Index samples) {
  Eigen::VectorXd input(samples);
  for (Eigen::Index k = 0; k < samples; ++k)
    input(k) = k < 10 ? 0.0 : (k / 40) % 2 == 0 ? 0.4 : -0.3;
  return input;
}

/// What the model does not explain when the plant has this channel.
Eigen::VectorXd error_of(const TransferFunction& plant, const Eigen::VectorXd& input) {
  return channel_response(plant, kSampleTime, input) - channel_response(kChannel, kSampleTime, input);
}

}  // namespace

TEST_CASE("mismatch profile: parameter and size of a mismatch without much noise") {
  const Eigen::VectorXd input = steps(300);
  const Eigen::VectorXd noise = 1e-4 * testing::white_noise(300, 31);
  const auto best = [&](const TransferFunction& plant) {
    return profiled_mismatches(error_of(plant, input) + noise, input, kChannel, kSampleTime, 2, 0.95).front();
  };
  // A noise of 1e-4 against responses of 1 leaves some 1e-4 of uncertainty.
  CHECK(best(kChannel.with_gain_scaled(0.6)).parameter == MismatchParameter::gain);
  CHECK(best(kChannel.with_gain_scaled(0.6)).value == Approx(0.6).epsilon(1e-3));
  CHECK(best(kChannel.with_gain_scaled(-1.0)).value == Approx(-1.0).epsilon(1e-3));
  CHECK(best(kChannel.with_time_scaled(2.3)).parameter == MismatchParameter::time_constant);
  CHECK(best(kChannel.with_time_scaled(2.3)).value == Approx(2.3).epsilon(1e-3));
  CHECK(best(kChannel.with_dead_time_shifted(-3.0)).parameter == MismatchParameter::dead_time);
  CHECK(best(kChannel.with_dead_time_shifted(-3.0)).value == Approx(-3.0).margin(0.01));
  CHECK(best(kChannel.with_dead_time_shifted(17.0)).value == Approx(17.0).margin(0.01));
}

TEST_CASE(
    "mismatch profile: the interval covers the size as often as is said, under white and coloured noise") {
  constexpr int kTrials = 200;
  const Eigen::VectorXd input = steps(200);
  const Eigen::VectorXd error = error_of(kChannel.with_gain_scaled(0.8), input);
  for (const double a : {0.0, 0.8}) {
    std::int64_t covered = 0;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      const Eigen::VectorXd e = error + 0.02 * testing::settled_autoregression(200, a, 830000 + trial);
      for (const ProfiledMismatch& each : profiled_mismatches(e, input, kChannel, kSampleTime, 1, 0.95))
        if (each.parameter == MismatchParameter::gain)
          covered += each.lower <= 0.8 && 0.8 <= each.upper ? 1 : 0;
    }
    INFO("a = " << a << ": " << covered << " of " << kTrials);
    CHECK(testing::clopper_pearson_interval(covered, kTrials, 0.999).contains(0.95));
  }
}

TEST_CASE("mismatch profile: the residual sum is that of least squares, and the first is the least") {
  const Eigen::VectorXd input = steps(120);
  const Eigen::VectorXd e = error_of(kChannel.with_time_scaled(1.5), input) + testing::white_noise(120, 41);
  const std::vector<ProfiledMismatch> found = profiled_mismatches(e, input, kChannel, kSampleTime, 0, 0.9);
  REQUIRE(found.size() == 3);
  CHECK(found[0].residual_sum <= found[1].residual_sum);
  CHECK(found[1].residual_sum <= found[2].residual_sum);
  for (const ProfiledMismatch& each : found) {
    CHECK(each.lower < each.value);
    CHECK(each.value < each.upper);
    if (each.parameter != MismatchParameter::gain)
      continue;
    // Of the gain it is a regression on the response, in closed form.
    const Eigen::VectorXd s = channel_response(kChannel, kSampleTime, input);
    const Eigen::VectorXd of_mean = s.array() - s.mean(), of_e = e.array() - e.mean();
    const double b = of_mean.dot(of_e) / of_mean.squaredNorm();
    CHECK(each.value == Approx(1.0 + b).epsilon(1e-3));  // the search ends within 1/2000 of its grid
    CHECK(each.residual_sum == Approx((of_e - b * of_mean).squaredNorm()));
  }
  CHECK_THROWS_AS(profiled_mismatches(e, input.head(100), kChannel, kSampleTime, 0, 0.9), InputError);
  CHECK_THROWS_WITH(profiled_mismatches(e, input, TransferFunction::zero(), kSampleTime, 0, 0.9),
                    Catch::Contains("without effect"));
}

}  // namespace mpm
