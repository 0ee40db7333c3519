#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/moving_moments.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/study/window_scan.hpp"
#include "tests/analysis/signals.hpp"

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using mpm::testing::autoregression;
using mpm::testing::white_noise;

struct Moments {
  VectorXd skewness;
  VectorXd kurtosis;
};

Moments moving(const VectorXd& signal, Index window) {
  const Index positions = signal.size() - window + 1;
  Moments moments{VectorXd(positions), VectorXd(positions)};
  mpm::moving_moments(signal, window, moments.skewness, moments.kurtosis);
  return moments;
}

/// (6.10) to (6.12) as they stand, each window by itself, in extended precision.
Moments naive(const VectorXd& signal, Index window) {
  const Index positions = signal.size() - window + 1;
  Moments moments{VectorXd(positions), VectorXd(positions)};
  for (Index first = 0; first < positions; ++first) {
    long double mean = 0.0L;
    for (Index i = first; i < first + window; ++i) {
      mean += static_cast<long double>(signal[i]) / static_cast<long double>(window);
    }
    long double m2 = 0.0L, m3 = 0.0L, m4 = 0.0L;
    for (Index i = first; i < first + window; ++i) {
      const long double a = static_cast<long double>(signal[i]) - mean;
      m2 += a * a / static_cast<long double>(window);
      m3 += a * a * a / static_cast<long double>(window);
      m4 += a * a * a * a / static_cast<long double>(window);
    }
    moments.skewness[first] = static_cast<double>(m3 / (m2 * std::sqrt(m2)));
    moments.kurtosis[first] = static_cast<double>(m4 / (m2 * m2));
  }
  return moments;
}

/// The largest error in the sense of the stated accuracy.
double error(const VectorXd& signal, Index window) {
  const Moments found = moving(signal, window);
  const Moments expected = naive(signal, window);
  double largest = 0.0;
  for (Index k = 0; k < found.skewness.size(); ++k) {
    REQUIRE(std::isfinite(found.skewness[k]));
    REQUIRE(std::isfinite(found.kurtosis[k]));
    largest = std::max(
        {largest,
         std::abs(found.skewness[k] - expected.skewness[k]) / std::max(1.0, std::abs(expected.skewness[k])),
         std::abs(found.kurtosis[k] / expected.kurtosis[k] - 1.0)});
  }
  return largest;
}

}  // namespace

TEST_CASE("the kurtosis of three values is 3/2 whatever they are, of four it is free") {
  const VectorXd signal = white_noise(60, 3);
  const VectorXd three = moving(signal, mpm::kShortestWindow - 1).kurtosis;
  CHECK((three.array() - 1.5).abs().maxCoeff() < 1e-9);  // kMovingMomentAccuracy
  const VectorXd four = moving(signal, mpm::kShortestWindow).kurtosis;
  CHECK(four.maxCoeff() - four.minCoeff() > 0.5);  // between 1 and 7/3
}

TEST_CASE("moving moments agree with the naive formulas within the stated accuracy") {
  for (const Index window : {3, 10, 38, 75, 150, 400}) {
    INFO("window " << window);
    CHECK(error(white_noise(400, 1), window) < mpm::kMovingMomentAccuracy);
    CHECK(error(autoregression(400, 0.98, 2), window) < mpm::kMovingMomentAccuracy);
  }
}

TEST_CASE("moving moments keep their accuracy on the signals that break plain running sums") {
  SECTION("far from zero: the offset takes 6 digits from the samples, not from the moments") {
    CHECK(error(white_noise(1000, 3).array() + 1e6, 50) < mpm::kMovingMomentAccuracy);
  }
  SECTION("a very long record") {
    CHECK(error(white_noise(200000, 4), 20) < mpm::kMovingMomentAccuracy);
  }
  SECTION("a large excursion that leaves the window before a quiet stretch") {
    VectorXd signal = 1e-4 * white_noise(600, 5);
    signal.segment(100, 20).array() += 1e3;
    CHECK(error(signal, 40) < mpm::kMovingMomentAccuracy);
  }
  SECTION("a level that steps up by many standard deviations") {
    VectorXd signal = 1e-3 * white_noise(600, 6);
    signal.tail(300).array() += 10.0;
    CHECK(error(signal, 60) < mpm::kMovingMomentAccuracy);
  }
  SECTION("a steep ramp") {
    const VectorXd signal = VectorXd::LinSpaced(500, 0.0, 1e5) + white_noise(500, 7);
    CHECK(error(signal, 30) < mpm::kMovingMomentAccuracy);
  }
  SECTION("amplitudes that fall by many decades") {
    VectorXd signal = white_noise(500, 8);
    for (Index k = 0; k < signal.size(); ++k) {
      signal[k] *= std::exp(-0.05 * static_cast<double>(k));
    }
    CHECK(error(signal, 25) < mpm::kMovingMomentAccuracy);
  }
}

TEST_CASE("moments of windows known in closed form") {
  // A sample of 0 0 0 1 (p = 1/4): skewness (1 - 2p)/sqrt(p(1-p)), kurtosis (1 - 3p(1-p))/(p(1-p)).
  const VectorXd pulse = (VectorXd(4) << 0.0, 0.0, 0.0, 1.0).finished();
  const Moments moments = moving(pulse, 4);
  const double variance = 3.0 / 16.0;
  // A few roundings of numbers of order 1.
  CHECK(moments.skewness[0] == Approx(0.5 / std::sqrt(variance)).epsilon(1e-14));
  CHECK(moments.kurtosis[0] == Approx((1.0 - 3.0 * variance) / variance).epsilon(1e-14));
  // n equidistant samples: skewness 0, kurtosis (3/5)(3n^2 - 7)/(n^2 - 1).
  const Moments ramp = moving(VectorXd::LinSpaced(30, 0.0, 29.0), 9);
  for (Index k = 0; k < ramp.skewness.size(); ++k) {
    CHECK(ramp.skewness[k] == Approx(0.0).margin(mpm::kMovingMomentAccuracy));
    CHECK(ramp.kurtosis[k] == Approx(0.6 * (3.0 * 81.0 - 7.0) / 80.0).epsilon(mpm::kMovingMomentAccuracy));
  }
}

TEST_CASE("moments do not depend on offset and scale; a mirrored signal mirrors the skewness") {
  const VectorXd signal = autoregression(300, 0.9, 9);
  const Moments base = moving(signal, 40);
  const Moments changed = moving(3.5 * signal.array() + 12.0, 40);
  const Moments mirrored = moving(-signal, 40);
  // Each side has the stated error; the offset costs 12/0.4 of 1e-16 more, which is nothing beside it.
  const double tolerance = 2.0 * mpm::kMovingMomentAccuracy * base.kurtosis.maxCoeff();
  CHECK((changed.skewness - base.skewness).cwiseAbs().maxCoeff() < tolerance);
  CHECK((changed.kurtosis - base.kurtosis).cwiseAbs().maxCoeff() < tolerance);
  CHECK((mirrored.skewness + base.skewness).cwiseAbs().maxCoeff() < tolerance);
  CHECK((mirrored.kurtosis - base.kurtosis).cwiseAbs().maxCoeff() < tolerance);
}

TEST_CASE("every window obeys kurtosis >= 1 + skewness^2") {
  const Moments moments = moving(autoregression(400, 0.95, 10), 12);
  const Eigen::ArrayXd slack = moments.kurtosis.array() - 1.0 - moments.skewness.array().square();
  CHECK(slack.minCoeff() > -1e-8);  // the stated error, times kurtosis of a few units
}

TEST_CASE("windows that stand still have no moments, and their neighbours do") {
  VectorXd signal = VectorXd::Constant(100, 0.1);
  signal.head(30) += white_noise(30, 11);
  signal[80] = 0.2;
  const Moments moments = moving(signal, 10);
  for (Index first = 0; first < moments.kurtosis.size(); ++first) {
    const bool flat = first >= 30 && (first + 9 < 80 || first > 80);
    INFO("window at " << first);
    CHECK(std::isnan(moments.skewness[first]) == flat);
    CHECK(std::isnan(moments.kurtosis[first]) == flat);
  }
  // One pulse in 10 samples, at every place in the window: p = 1/10 in the closed form above.
  for (Index first = 71; first <= 80; ++first) {
    CHECK(moments.kurtosis[first] == Approx((1.0 - 0.27) / 0.09).epsilon(mpm::kMovingMomentAccuracy));
  }
}

TEST_CASE("variation by rounding alone is no variation") {
  VectorXd signal(60);
  for (Index k = 0; k < 60; ++k) {
    signal[k] = k % 2 == 0 ? 0.3 : 0.1 + 0.2;  // differ by one unit in the last place
  }
  REQUIRE(signal[0] != signal[1]);
  CHECK(moving(signal, 10).kurtosis.array().isNaN().all());
  CHECK(moving(VectorXd::Zero(60), 10).kurtosis.array().isNaN().all());
}

TEST_CASE("moving moments refuse impossible input") {
  using mpm::InputError;
  const VectorXd signal = white_noise(20, 12);
  VectorXd skewness(16), kurtosis(16);
  CHECK_NOTHROW(mpm::moving_moments(signal, 5, skewness, kurtosis));
  CHECK_THROWS_AS(mpm::moving_moments(signal, 1, skewness, kurtosis), InputError);
  CHECK_THROWS_AS(mpm::moving_moments(signal, 21, skewness, kurtosis), InputError);
  CHECK_THROWS_AS(mpm::moving_moments(signal, 6, skewness, kurtosis), InputError);
  CHECK_THROWS_AS(mpm::moving_moments(signal, 5, skewness.head(15), kurtosis), InputError);
  CHECK_THROWS_AS(mpm::moving_moments(signal.head(1), 1, skewness.head(1), kurtosis.head(1)), InputError);
  VectorXd bad = signal;
  bad[7] = mpm::kNaN;
  CHECK_THROWS_WITH(mpm::moving_moments(bad, 5, skewness, kurtosis),
                    "signal: found no value at sample 7; allowed: finite values only");
  bad[7] = mpm::kInfinity;
  CHECK_THROWS_AS(mpm::moving_moments(bad, 5, skewness, kurtosis), InputError);
}
