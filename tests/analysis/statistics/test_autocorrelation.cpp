#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/statistics/autocorrelation.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using mpm::autocorrelation;
using mpm::testing::autoregression;
using mpm::testing::white_noise;

TEST_CASE("autocorrelation by hand") {
  // Deviations -1.5 -0.5 0.5 1.5: power 5, products 1.25, -1.5, -2.25 at the lags 1, 2, 3.
  const VectorXd ramp = (VectorXd(4) << 1.0, 2.0, 3.0, 4.0).finished();
  const auto acf = autocorrelation(ramp, 3);
  CHECK(acf.values[0] == 1.0);
  CHECK(acf.values[1] == Approx(0.25).epsilon(1e-15));
  CHECK(acf.values[2] == Approx(-0.3).epsilon(1e-15));
  CHECK(acf.values[3] == Approx(-0.45).epsilon(1e-15));
  // About 0: power 30, products 20, 11, 4.
  const auto raw = autocorrelation(ramp, 3, 0.95, 0.0);
  CHECK(raw.values[1] == Approx(20.0 / 30.0).epsilon(1e-15));
  CHECK(raw.values[2] == Approx(11.0 / 30.0).epsilon(1e-15));
  CHECK(raw.values[3] == Approx(4.0 / 30.0).epsilon(1e-15));
}

TEST_CASE("the bands are those of white noise and of Bartlett") {
  const auto acf = autocorrelation(autoregression(400, 0.7, 1), 20);
  CHECK(acf.white_band == Approx(1.959963984540054 / 20.0).epsilon(1e-14));
  CHECK(acf.bartlett_band[0] == 0.0);
  CHECK(acf.bartlett_band[1] == acf.white_band);
  const double r1 = acf.values[1];
  const double r2 = acf.values[2];
  CHECK(acf.bartlett_band[3] ==
        Approx(acf.white_band * std::sqrt(1.0 + 2.0 * r1 * r1 + 2.0 * r2 * r2)).epsilon(1e-14));
  CHECK(autocorrelation(white_noise(400, 2), 5, 0.99).white_band ==
        Approx(2.5758293035489004 / 20.0).epsilon(1e-14));
}

TEST_CASE("white noise leaves its band in 5 % of the lags") {
  int outside = 0;
  constexpr int kRecords = 50;
  constexpr int kLags = 40;
  for (std::uint64_t record = 0; record < kRecords; ++record) {
    const auto acf = autocorrelation(white_noise(500, 10 + record), kLags);
    for (Index lag = 1; lag <= kLags; ++lag) {
      outside += std::abs(acf.values[lag]) > acf.white_band ? 1 : 0;
    }
  }
  // The lags are nearly independent: 100 expected, standard deviation sqrt(2000 * 0.05 * 0.95) = 9.7. The
  // biased estimator shrinks by (N - l)/N and so lowers the mean to about 90.
  CHECK(outside > 90 - 4 * 9.7);
  CHECK(outside < 100 + 4 * 9.7);
}

TEST_CASE("a first-order autoregression has the autocorrelation a^l") {
  const Index samples = 20000;
  const double a = 0.8;
  const auto acf = autocorrelation(autoregression(samples, a, 3), 10);
  for (Index lag = 1; lag <= 10; ++lag) {
    // Bartlett's standard error is at most sqrt((1 + a^2)/(1 - a^2)/N) = 0.015.
    CHECK(std::abs(acf.values[lag] - std::pow(a, static_cast<double>(lag))) < 4.0 * 0.0151);
  }
}

TEST_CASE("an autocorrelation does not depend on offset and scale, and stays within 1") {
  const VectorXd signal = autoregression(200, 0.9, 4);
  const VectorXd base = autocorrelation(signal, 50).values;
  const VectorXd changed = autocorrelation(-3.0 * signal.array() + 40.0, 50).values;
  CHECK((base - changed).cwiseAbs().maxCoeff() < 1e-12);  // 200 roundings, 40/6 times enlarged by the offset
  CHECK(base.cwiseAbs().maxCoeff() <= 1.0);
}

TEST_CASE("a signal that stands still has no autocorrelation") {
  const auto acf = autocorrelation(VectorXd::Constant(50, 0.1), 3);
  CHECK(acf.values.array().isNaN().all());
  CHECK(acf.bartlett_band.array().isNaN().all());
  CHECK(acf.values.size() == 4);
  CHECK(std::isnan(autocorrelation(VectorXd::Constant(400, 0.3), 3).values[1]));  // its mean is not 0.3
  // About another centre it has: a constant deviation.
  CHECK(autocorrelation(VectorXd::Constant(50, 0.1), 3, 0.95, 0.0).values[1] == Approx(49.0 / 50.0));
}

TEST_CASE("an autocorrelation refuses impossible input") {
  using mpm::InputError;
  const double nan = mpm::kNaN;
  const VectorXd signal = white_noise(20, 5);
  CHECK_NOTHROW(autocorrelation(signal, 19));
  CHECK_THROWS_AS(autocorrelation(signal, 20), InputError);
  CHECK_THROWS_AS(autocorrelation(signal, -1), InputError);
  CHECK_THROWS_AS(autocorrelation(signal.head(1), 0), InputError);
  CHECK_THROWS_AS(autocorrelation(signal, 5, 1.0), InputError);
  CHECK_THROWS_AS(autocorrelation(signal, 5, 0.95, nan), InputError);
  CHECK_THROWS_AS(autocorrelation(VectorXd::Constant(20, nan), 5), InputError);
}
