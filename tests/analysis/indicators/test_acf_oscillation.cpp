#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/indicators/acf_oscillation.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using mpm::acf_oscillation;
using mpm::AcfOscillation;
using mpm::Autocorrelation;
using mpm::autocorrelation;
using mpm::Oscillation;
using mpm::testing::settled_autoregression;
using mpm::testing::settled_second_order;
using mpm::testing::white_noise;

namespace {

/// The autocorrelation of a second-order system with damping `zeta` and damped period `period` under white
/// noise, with narrow bands.
Autocorrelation second_order(double zeta, double period, Index lags) {
  const double root = std::sqrt(1.0 - zeta * zeta);
  const double damped = 2.0 * std::numbers::pi / period;
  Autocorrelation acf;
  acf.values.resize(lags + 1);
  for (Index lag = 0; lag <= lags; ++lag) {
    const double angle = damped * static_cast<double>(lag);
    acf.values[lag] = std::exp(-zeta / root * angle) * (std::cos(angle) + zeta / root * std::sin(angle));
  }
  acf.white_band = 0.01;
  acf.bartlett_band = VectorXd::Constant(lags + 1, acf.white_band);
  return acf;
}

}  // namespace

TEST_CASE("the decay ratio of a second-order system is its decay over half a period") {
  for (const double zeta : {0.02, 0.1, 0.2, 0.23, 0.3}) {
    const double expected = std::exp(-std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta));
    const AcfOscillation found = acf_oscillation(second_order(zeta, 40.0, 100));  // extremes at 20, 40, 60
    CHECK(found.decay_ratio == Approx(expected).epsilon(1e-12));
    CHECK(found.period == 40.0);
    CHECK(found.verdict == (expected >= 0.5 ? Oscillation::present : Oscillation::absent));
  }
  CHECK(acf_oscillation(second_order(0.23, 40.0, 100), 0.4).verdict == Oscillation::present);
}

TEST_CASE("a drift under the oscillation does not change its decay ratio") {
  Autocorrelation acf = second_order(0.1, 40.0, 100);
  const double plain = acf_oscillation(acf).decay_ratio;
  for (Index lag = 0; lag <= 100; ++lag) {
    acf.values[lag] = 0.7 * acf.values[lag] + 0.3 * (1.0 - static_cast<double>(lag) / 200.0);
  }
  REQUIRE(acf.values[20] > -0.3);
  // A slope moves the extremes a little, which changes their heights in the second order.
  CHECK(acf_oscillation(acf).decay_ratio == Approx(plain).epsilon(0.01));
}

TEST_CASE("an oscillation needs bands narrower than its swing, lags for two minima, and regular swings") {
  Autocorrelation acf = second_order(0.1, 40.0, 100);
  REQUIRE(acf_oscillation(acf).verdict == Oscillation::present);
  CHECK(acf_oscillation(second_order(0.1, 40.0, 59)).verdict == Oscillation::absent);
  CHECK(std::isnan(acf_oscillation(second_order(0.1, 40.0, 59)).decay_ratio));
  acf.bartlett_band.setConstant(2.0);
  CHECK(acf_oscillation(acf).verdict == Oscillation::absent);
  acf.bartlett_band.setZero();
  acf.white_band = 2.0;
  CHECK(std::isnan(acf_oscillation(acf).period));
  // Turning points at 1, 6 and 7.
  Autocorrelation irregular;
  irregular.values = (VectorXd(9) << 1.0, -0.8, -0.5, -0.2, 0.1, 0.4, 0.7, -0.7, 0.0).finished();
  irregular.white_band = 0.01;
  irregular.bartlett_band = VectorXd::Constant(9, 0.01);
  CHECK(acf_oscillation(irregular).decay_ratio > 0.5);
  CHECK(acf_oscillation(irregular).verdict == Oscillation::absent);
}

TEST_CASE("records of a second-order autoregression: decay ratio, period and verdict") {
  const auto run = [](double half_period_decay, double period) {
    std::vector<double> ratios;
    int present = 0;
    for (std::uint64_t record = 0; record < 60; ++record) {
      const VectorXd signal = settled_second_order(1000, half_period_decay, period, record);
      const auto found = acf_oscillation(autocorrelation(signal, 250));
      present += found.verdict == Oscillation::present ? 1 : 0;
      ratios.push_back(found.decay_ratio);
      if (half_period_decay > 0.6) {
        CHECK(found.period == Approx(period).margin(0.15 * period));
      }
    }
    std::sort(ratios.begin(), ratios.end());
    CHECK(ratios[30] ==
          Approx(half_period_decay).margin(0.08));  // bias of a sample function: up to 0.04 seen
    return present;
  };
  // Of 300 records of each kind between 97 and 100 % were found at 0.7, and 4 % at 0.3.
  CHECK(run(0.8, 20.0) >= 58);
  CHECK(run(0.7, 10.0) >= 57);
  CHECK(run(0.3, 20.0) <= 10);
}

TEST_CASE("a sinusoid in noise") {
  VectorXd signal = white_noise(400, 1);
  for (Index k = 0; k < signal.size(); ++k) {
    signal[k] += 2.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / 25.0);
  }
  const auto found = acf_oscillation(autocorrelation(signal, 100));
  CHECK(found.verdict == Oscillation::present);
  CHECK(found.period == Approx(25.0).margin(1.5));
  // An amplitude of 1/4, 3 % of the power, stays in the noise.
  const VectorXd faint = signal - 0.875 * (signal - white_noise(400, 1));
  CHECK(acf_oscillation(autocorrelation(faint, 100)).verdict == Oscillation::absent);
}

TEST_CASE("signals that do not oscillate are seldom said to") {
  for (const double a : {0.0, 0.5, 0.8, 0.9, 0.95}) {
    for (const Index samples : {400, 1000}) {
      int false_alarms = 0;
      for (std::uint64_t record = 0; record < 100; ++record) {
        const VectorXd signal = settled_autoregression(samples, a, 10 + record);
        const auto found = acf_oscillation(autocorrelation(signal, samples / 4));
        false_alarms += found.verdict == Oscillation::present ? 1 : 0;
      }
      INFO("a = " << a << ", " << samples << " samples: " << false_alarms << " of 100");
      CHECK(false_alarms <= 12);  // at most 6 % of 300 records seen; 3 binomial deviations above
    }
  }
}

TEST_CASE("oscillation: a signal that stands still, and refused input") {
  const auto still = acf_oscillation(autocorrelation(VectorXd::Constant(50, 0.1), 10));
  CHECK(still.verdict == Oscillation::undetermined);
  CHECK(std::isnan(still.decay_ratio));
  CHECK(acf_oscillation(Autocorrelation{}).verdict == Oscillation::undetermined);
  for (const double bad : {0.0, 1.0, mpm::kNaN}) {
    CHECK_THROWS_AS(acf_oscillation(autocorrelation(white_noise(50, 2), 10), bad), mpm::InputError);
  }
  CHECK(mpm::to_string(Oscillation::present) == "present");
  CHECK(mpm::to_string(Oscillation::absent) == "absent");
  CHECK(mpm::to_string(Oscillation::undetermined) == "undetermined");
}
