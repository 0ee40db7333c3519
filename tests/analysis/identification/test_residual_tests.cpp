#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/identification/residual_tests.hpp"
#include "analysis/statistics/interval.hpp"
#include "plants/error.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/scenarios/goodness_of_fit.hpp"

using mpm::input_correlation;
using mpm::ljung_box_test;
using mpm::testing::autoregression;
using mpm::testing::white_noise;

TEST_CASE("Ljung-Box: p-values of white noise are uniform") {
  std::vector<double> p_values;
  for (std::uint64_t number = 0; number < 1000; ++number)
    p_values.push_back(ljung_box_test(white_noise(500, 400000 + number), 15).p_value);
  // The statistic is chi-square to terms of 1/N only; the critical distance leaves room for that.
  CHECK(mpm::testing::kolmogorov_distance(p_values, [](double p) { return p; }) <
        mpm::testing::kolmogorov_critical(p_values.size()));
}

TEST_CASE("Ljung-Box: correlated residuals are found, and few degrees of freedom are counted") {
  CHECK(ljung_box_test(autoregression(500, 0.4, 1), 15).p_value < 1e-6);
  CHECK(ljung_box_test(white_noise(500, 2), 15, 4).degrees_of_freedom == 11);
  // By hand: residuals 1, -1, 1, -1 have r_1 = -3/4, and Q = 4 6 (9/16)/3.
  CHECK(ljung_box_test(Eigen::Vector4d(1.0, -1.0, 1.0, -1.0), 1).statistic == Approx(4.5));
  CHECK(std::isnan(ljung_box_test(Eigen::VectorXd::Zero(50), 5).p_value));
}

TEST_CASE("correlation with an input: independent coloured signals keep to band and test") {
  constexpr int kTrials = 600;
  constexpr Eigen::Index kLag = 10;
  std::int64_t rejected = 0;
  std::int64_t outside = 0;
  for (std::uint64_t number = 0; number < kTrials; ++number) {
    const Eigen::VectorXd e = autoregression(1500, 0.6, 500000 + 2 * number);
    const Eigen::VectorXd u = autoregression(1500, 0.7, 500001 + 2 * number).array() + 5.0;
    const mpm::InputCorrelation correlation = input_correlation(e, u, kLag);
    rejected += correlation.test.p_value < 0.05 ? 1 : 0;
    outside += std::abs(correlation.values(kLag + 3)) > correlation.band ? 1 : 0;
  }
  CHECK(mpm::clopper_pearson_interval(rejected, kTrials, 0.999).contains(0.05));
  CHECK(mpm::clopper_pearson_interval(outside, kTrials, 0.999).contains(0.05));
}

TEST_CASE("correlation with an input: a missing effect stands at its lag, feedback at a negative one") {
  const Eigen::VectorXd u = white_noise(800, 3);
  Eigen::VectorXd e = white_noise(800, 4);
  e.tail(796) += 0.5 * u.head(796);
  const mpm::InputCorrelation missing = input_correlation(e, u, 8);
  Eigen::Index at = 0;
  missing.values.cwiseAbs().maxCoeff(&at);
  CHECK(at == 8 + 4);
  // E e(k) u(k-4) = 0.5 with variances 1.25 and 1; standard error 1/sqrt(800) = 0.035.
  CHECK(missing.values(at) == Approx(0.5 / std::sqrt(1.25)).margin(0.12));
  CHECK(missing.test.p_value < 1e-6);

  const mpm::InputCorrelation feedback = input_correlation(u, e, 8);
  feedback.values.cwiseAbs().maxCoeff(&at);
  CHECK(at == 8 - 4);
  CHECK(feedback.test.p_value > 0.01);  // only lags from 0 on count
}

TEST_CASE("correlation with an input: the band of white residuals is that of one correlation") {
  const mpm::InputCorrelation correlation = input_correlation(white_noise(2000, 5), white_noise(2000, 6), 5);
  // P = 1 but for estimated correlations that are not quite 0: about 90 products of (1/sqrt(2000))^2.
  CHECK(correlation.band == Approx(1.96 / std::sqrt(2000.0)).epsilon(0.02));
  CHECK(correlation.test.degrees_of_freedom == 6);
}

TEST_CASE("tests of residuals refuse what cannot be meant") {
  const Eigen::VectorXd e = white_noise(40, 7);
  CHECK_THROWS_WITH(ljung_box_test(e, 5, 5), Catch::Contains("0 <= fitted < lags < 40"));
  CHECK_THROWS_WITH(ljung_box_test(e, 40), Catch::Contains("found 40 and 0"));
  CHECK_THROWS_WITH(input_correlation(e, e, 11), Catch::Contains("0 to 10"));
  CHECK_THROWS_AS(input_correlation(e, e.head(39), 5), mpm::InputError);
  CHECK_THROWS_AS(input_correlation(e, e, 5, 1.0), mpm::InputError);
  CHECK(std::isnan(input_correlation(e, Eigen::VectorXd::Ones(40), 5).test.p_value));
}
