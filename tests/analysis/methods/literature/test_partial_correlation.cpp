#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "analysis/methods/literature/partial_correlation.hpp"
#include "analysis/statistics/interval.hpp"
#include "base/error.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

using mpm::partial_correlation;
using mpm::PartialCorrelation;
using mpm::testing::settled_autoregression;
using mpm::testing::white_noise;

namespace {

Eigen::VectorXd sine(Eigen::Index samples, int periods) {
  const double step = 2.0 * std::numbers::pi * periods / static_cast<double>(samples);
  return Eigen::VectorXd::NullaryExpr(
      samples, [=](Eigen::Index k) { return std::sin(step * static_cast<double>(k)); });
}

/// sum_k a(k) b(k-l), term by term.
double lagged_sum(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index lag) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < a.size(); ++k)
    if (k - lag >= 0 && k - lag < b.size())
      sum += a(k) * b(k - lag);
  return sum;
}

}  // namespace

TEST_CASE("partial correlation: an orthogonal input gives zero") {
  const PartialCorrelation correlation = partial_correlation(sine(300, 5), sine(300, 8), 0, 0, 0.95);
  CHECK(std::abs(correlation.peak) < 1e-14);  // rounding of 300 products
  CHECK_FALSE(correlation.is_strong());
}

TEST_CASE("partial correlation: values and band are those of the defining sums") {
  constexpr Eigen::Index kSamples = 250;
  constexpr Eigen::Index kParameters = 50;
  Eigen::VectorXd eps1 = settled_autoregression(kSamples, 0.6, 11);
  Eigen::VectorXd eps2 = settled_autoregression(kSamples, 0.8, 12);
  eps1.array() -= eps1.mean();
  eps2.array() -= eps2.mean();
  const PartialCorrelation correlation = partial_correlation(eps1, eps2, 1, 9, 0.95, kParameters);

  const double size = std::sqrt(eps1.squaredNorm() * eps2.squaredNorm());
  for (Eigen::Index l = 1; l <= 9; ++l)
    CHECK(correlation.values(l - 1) == Approx(lagged_sum(eps2, eps1, l) / size).margin(1e-14));
  CHECK(correlation.peak == correlation.values(correlation.lag - 1));
  CHECK(std::abs(correlation.peak) == correlation.values.cwiseAbs().maxCoeff());

  // Bartlett's sum over |m| <= 2 sqrt(250) = 32, with his window.
  double P = 0.0;
  for (int m = -32; m <= 32; ++m)
    P += (1.0 - std::abs(m) / 33.0) * lagged_sum(eps1, eps1, m) / eps1.squaredNorm() *
         lagged_sum(eps2, eps2, m) / eps2.squaredNorm();
  const double z = mpm::two_sided_normal_quantile(0.95);
  CHECK(correlation.band == Approx(z * std::sqrt(P / 200.0)));
  CHECK(correlation.white_band == Approx(z / std::sqrt(200.0)));
}

TEST_CASE("partial correlation: a delayed copy is found at its delay, with its sign") {
  const Eigen::VectorXd eps1 = white_noise(600, 21);
  Eigen::VectorXd eps2 = Eigen::VectorXd::Zero(600);
  eps2.tail(593) = -2.0 * eps1.head(593);
  const PartialCorrelation correlation = partial_correlation(eps1, eps2, 1, 20, 0.95);
  CHECK(correlation.lag == 7);
  CHECK(correlation.peak == Approx(-1.0).margin(0.02));  // the last 7 of 600 samples are missing
  CHECK(correlation.is_strong());
  CHECK_FALSE(correlation.is_strong(1.0));
}

TEST_CASE(
    "partial correlation: Bartlett's band has the nominal false alarms of coloured series, the white one has "
    "not") {
  constexpr int kTrials = 1000;
  std::int64_t outside = 0;
  std::int64_t outside_white = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const PartialCorrelation correlation =
        partial_correlation(settled_autoregression(800, 0.8, 700000 + 2 * trial),
                            settled_autoregression(800, 0.8, 700001 + 2 * trial), 4, 4, 0.95);
    outside += std::abs(correlation.peak) > correlation.band ? 1 : 0;
    outside_white += std::abs(correlation.peak) > correlation.white_band ? 1 : 0;
  }
  // The window of the band leaves out a little of P = (1 + 0.64)/(1 - 0.64), so the rate may be just above.
  const mpm::Interval interval = mpm::testing::clopper_pearson_interval(outside, kTrials, 0.999);
  CHECK(interval.lower < 0.05);
  CHECK(interval.upper > 0.05);
  // A deviation of sqrt(4.56) = 2.13 bands: P(|Z| > 1.96/2.13) = 0.36.
  CHECK(mpm::testing::clopper_pearson_interval(outside_white, kTrials, 0.999).contains(0.36));
}

TEST_CASE("partial correlation: nothing left is no correlation, and bad arguments are refused") {
  const Eigen::VectorXd eps = white_noise(100, 31);
  const PartialCorrelation nothing = partial_correlation(Eigen::VectorXd::Zero(100), eps, 1, 5, 0.95);
  CHECK(std::isnan(nothing.peak));
  CHECK_FALSE(nothing.is_strong());
  CHECK_THROWS_WITH(partial_correlation(eps, eps, 6, 5, 0.95), Catch::Contains("6 to 5"));
  CHECK_THROWS_WITH(partial_correlation(eps, eps, -1, 5, 0.95), Catch::Contains("0 or more"));
  CHECK_THROWS_WITH(partial_correlation(eps, eps, 1, 26, 0.95), Catch::Contains("0 to 25"));
  CHECK_THROWS_WITH(partial_correlation(eps, eps, 1, 5, 0.95, 100), Catch::Contains("0 to 99"));
  CHECK_THROWS_AS(partial_correlation(eps, eps.head(99), 1, 5, 0.95), mpm::InputError);
}
