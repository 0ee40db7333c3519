#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/methods/literature/variance_ratio_limits.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/error.hpp"
#include "tests/analysis/signals.hpp"

using mpm::autocorrelation_factor;
using mpm::Interval;
using mpm::variance_ratio_limits;
using mpm::VarianceSample;
using mpm::testing::settled_autoregression;
using mpm::testing::white_noise;

namespace {

/// (2.9) as it is printed, sums and all.
double printed_factor(const Eigen::VectorXd& x, Eigen::Index lags) {
  const auto n = static_cast<double>(x.size());
  double mean = 0.0;
  for (const double value : x)
    mean += value / n;
  double power = 0.0;
  for (const double value : x)
    power += (value - mean) * (value - mean);
  double f = 1.0;
  for (Eigen::Index j = 1; j <= lags; ++j) {
    double sum = 0.0;
    for (Eigen::Index k = j; k < x.size(); ++k)
      sum += (x(k) - mean) * (x(k - j) - mean);
    f += 2.0 * (1.0 - static_cast<double>(j) / n) * (sum / power) * (sum / power);
  }
  return f;
}

/// Share of pairs of autoregressions whose interval holds the true ratio of their variances.
double coverage(double a_benchmark, double a_monitored, Eigen::Index samples, Eigen::Index largest_lag,
                int pairs) {
  const double truth = (1.0 - a_benchmark * a_benchmark) / (1.0 - a_monitored * a_monitored);
  int held = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto number = static_cast<std::uint64_t>(2 * i);
    const Eigen::VectorXd benchmark = settled_autoregression(samples, a_benchmark, 700000 + number);
    const Eigen::VectorXd monitored = settled_autoregression(samples, a_monitored, 700001 + number);
    const Interval limits =
        variance_ratio_limits(mpm::variance(monitored) / mpm::variance(benchmark),
                              {samples, autocorrelation_factor(benchmark, largest_lag)},
                              {samples, autocorrelation_factor(monitored, largest_lag)}, 0.95);
    held += limits.contains(truth) ? 1 : 0;
  }
  return static_cast<double>(held) / pairs;
}

}  // namespace

TEST_CASE("autocorrelation factor: the printed sum, with all lags and with some") {
  const Eigen::VectorXd x = settled_autoregression(60, 0.7, 1).array() + 20.0;
  CHECK(autocorrelation_factor(x) == Approx(printed_factor(x, 60)));  // the term of j = n is 0
  CHECK(autocorrelation_factor(x, 60) == autocorrelation_factor(x));
  CHECK(autocorrelation_factor(x, 1000) == autocorrelation_factor(x));
  CHECK(autocorrelation_factor(x, 5) == Approx(printed_factor(x, 5)));
  // By hand: 1, -1, 1, -1 has r = -3/4, 2/4, -1/4.
  const double by_hand = 1.0 + 2.0 * (0.75 * 9.0 / 16 + 0.5 * 4.0 / 16 + 0.25 * 1.0 / 16);
  CHECK(autocorrelation_factor(Eigen::Vector4d(1.0, -1.0, 1.0, -1.0)) == Approx(by_hand));
  CHECK(autocorrelation_factor(Eigen::VectorXd::Constant(500, 0.1)) == 1.0);
}

TEST_CASE("autocorrelation factor: 5/3 for white noise with all lags, the true factor with few") {
  constexpr int kSignals = 200;
  double all = 0.0;
  double few = 0.0;
  double correlated = 0.0;
  for (std::uint64_t number = 0; number < kSignals; ++number) {
    all += autocorrelation_factor(white_noise(1000, 800000 + number)) / kSignals;
    few += autocorrelation_factor(white_noise(1000, 800000 + number), 10) / kSignals;
    correlated += autocorrelation_factor(settled_autoregression(1000, 0.8, 900000 + number), 20) / kSignals;
  }
  // E r_j^2 = (1 - j/n)/n, and the sum of (1 - x)^2 is 1/3. A single factor varies by some 0.04.
  CHECK(all == Approx(5.0 / 3.0).margin(0.02));
  CHECK(few == Approx(1.0).margin(0.03));
  // 1 + 2 sum 0.64^j = 4.56; r_j is biased towards 0 and 20 lags add 2 20/1000 of it. It varies by about 1.
  CHECK(correlated == Approx(4.56).margin(0.35));
}

TEST_CASE("limits of a ratio of variances: by hand, and the ratio between them") {
  // h = 1.959964 sqrt(2 (3/300 + 5/500)) = 0.391993
  const Interval limits = variance_ratio_limits(2.0, {301, 3.0}, {501, 5.0}, 0.95);
  CHECK(limits.lower == Approx(2.0 / 1.391993));
  CHECK(limits.upper == Approx(2.0 / 0.608007));
  const Interval wider = variance_ratio_limits(2.0, {301, 3.0}, {501, 5.0}, 0.99);
  CHECK(wider.lower < limits.lower);
  CHECK(wider.upper > limits.upper);
}

TEST_CASE("limits of a ratio of variances: without an upper end when the records are too short") {
  const Interval limits = variance_ratio_limits(0.01, {17, 1.0}, {17, 1.0}, 0.95);  // h = 0.98
  CHECK(limits.upper == Approx(0.01 / (1.0 - 1.959964 * 0.5)));
  const Interval open = variance_ratio_limits(0.01, {16, 1.0}, {16, 1.0}, 0.95);  // h = 1.01
  CHECK(std::isinf(open.upper));
  CHECK(open.upper > 0.0);
  CHECK(open.lower > 0.0);
  CHECK(std::isinf(variance_ratio_limits(0.0, {3, 1.0}, {3, 1.0}, 0.95).upper));
}

TEST_CASE("limits of a ratio of variances hold the truth as often as they claim") {
  // The standard error of a share of 0.95 of 800 pairs is 0.0077; margins of 3 of them.
  SECTION("with few lags about as often") {
    CHECK(coverage(0.0, 0.0, 400, 20, 800) == Approx(0.95).margin(0.023));
    // An autoregression's r_j^2 is underestimated where it counts: a little less often.
    CHECK(coverage(0.8, 0.5, 400, 20, 800) == Approx(0.94).margin(0.03));
  }
  SECTION("with all lags more often") {
    // sqrt(5/3) 1.96 = 2.53 standard errors: 0.989.
    CHECK(coverage(0.0, 0.0, 400, 0, 800) == Approx(0.989).margin(0.011));
    CHECK(coverage(0.8, 0.5, 400, 0, 800) > 0.95);
  }
}

TEST_CASE("limits of a ratio of variances refuse what cannot be meant") {
  CHECK_THROWS_WITH(variance_ratio_limits(-1.0, {9, 1.0}, {9, 1.0}, 0.95), Catch::Contains("found -1"));
  CHECK_THROWS_WITH(variance_ratio_limits(1.0, {9, 1.0}, {1, 1.0}, 0.95), Catch::Contains("2 or more"));
  CHECK_THROWS_WITH(variance_ratio_limits(1.0, {9, 1.0}, {9, 1.0}, 1.0), Catch::Contains("confidence"));
  CHECK_THROWS_WITH(autocorrelation_factor(white_noise(20, 1), -1), Catch::Contains("largest lag"));
  CHECK_THROWS_AS(autocorrelation_factor(white_noise(1, 1)), mpm::InputError);
}
