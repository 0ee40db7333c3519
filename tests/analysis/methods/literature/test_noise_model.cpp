#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/identification/polynomial_model.hpp"
#include "analysis/methods/literature/noise_model.hpp"
#include "base/error.hpp"
#include "tests/analysis/signals.hpp"

using mpm::autoregressive_noise;
using mpm::integrated_noise;
using mpm::NoiseModel;
using mpm::one_step_errors;
using mpm::testing::white_noise;

TEST_CASE("noise model: with the true disturbance model the prediction errors are the innovations") {
  const Eigen::VectorXd e = white_noise(300, 330);
  const Eigen::VectorXd y_sim = white_noise(300, 331);
  Eigen::VectorXd y = y_sim;
  double v = 0.0, v_before = 0.0;  // D v = C e, C = 1 + 0.4 q^-1, D = 1 - 0.9 q^-1 + 0.2 q^-2
  for (Eigen::Index k = 0; k < 300; ++k) {
    const double v_now = 0.9 * v - 0.2 * v_before + e(k) + (k > 0 ? 0.4 * e(k - 1) : 0.0);
    y(k) += v_now;
    v_before = v;
    v = v_now;
  }
  const NoiseModel G_d0{Eigen::Vector2d(1.0, 0.4), Eigen::Vector3d(1.0, -0.9, 0.2)};
  CHECK(G_d0.order() == 2);
  CHECK((one_step_errors(G_d0, y, y_sim) + e).cwiseAbs().maxCoeff() < 1e-12);  // e^p = y_hat - y = -e
}

TEST_CASE(
    "noise model: (2.2) evaluated as it is printed, with the general predictor, gives the same errors") {
  const Eigen::VectorXd y_sim = white_noise(200, 332);
  const Eigen::VectorXd y = y_sim + mpm::testing::autoregression(200, 0.7, 333);
  const NoiseModel G_d0 = integrated_noise(0.4);
  mpm::PolynomialModel model;  // y = 1 y_sim + (C/D) e
  model.inputs = {{Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1), 0}};
  model.C = G_d0.C;
  model.D = G_d0.D;
  const Eigen::VectorXd e = prediction_errors(model, y, y_sim.transpose());
  CHECK((one_step_errors(G_d0, y, y_sim) + e).cwiseAbs().maxCoeff() < 1e-12);  // e_p = y_hat - y
}

TEST_CASE("noise model: integrated noise predicts by the weighted past output errors") {
  const double c = 0.6;
  const Eigen::VectorXd v = white_noise(120, 334);
  const Eigen::VectorXd e_p = one_step_errors(integrated_noise(c), v, Eigen::VectorXd::Zero(120));
  for (const Eigen::Index k : {0, 1, 7, 119}) {
    double predicted = 0.0;
    for (Eigen::Index i = 1; i <= k; ++i)
      predicted += (1.0 - c) * std::pow(c, static_cast<double>(i - 1)) * v(k - i);
    CHECK(e_p(k) == Approx(predicted - v(k)).margin(1e-13));
  }
}

TEST_CASE("noise model: of white output errors integrated noise makes errors of variance 2/(1 + c)") {
  const Eigen::Index N = 40000;
  const Eigen::VectorXd v = white_noise(N, 335);
  for (const double c : {0.0, 0.382, 0.9}) {
    const Eigen::VectorXd e_p = one_step_errors(integrated_noise(c), v, Eigen::VectorXd::Zero(N));
    // 5 standard errors of a mean square of N values: sqrt(2/N), with room for their correlation.
    CHECK(e_p.squaredNorm() / static_cast<double>(N) == Approx(2.0 / (1.0 + c)).epsilon(0.05));
  }
}

TEST_CASE("noise model: an autoregression is found in its own record, and white noise has none") {
  const Eigen::VectorXd v = mpm::testing::settled_second_order(5000, 0.4, 12.0, 336);
  const NoiseModel found = autoregressive_noise(v, 6);
  REQUIRE(found.order() == 2);
  CHECK(found.C.size() == 1);
  const double radius = std::pow(0.4, 2.0 / 12.0);
  // 5 standard errors of the coefficients, below 1/sqrt(5000) each.
  CHECK(found.D(1) == Approx(-2.0 * radius * std::cos(2.0 * std::numbers::pi / 12.0)).margin(0.07));
  CHECK(found.D(2) == Approx(radius * radius).margin(0.07));
  CHECK(autoregressive_noise(white_noise(2000, 337), 6).order() == 0);
  CHECK(autoregressive_noise(Eigen::VectorXd::Zero(50), 6).order() == 0);
  CHECK(autoregressive_noise(v, 0).order() == 0);
}

TEST_CASE("noise model: what cannot be meant is refused") {
  const Eigen::VectorXd v = white_noise(20, 338);
  CHECK_THROWS_WITH(integrated_noise(1.0), Catch::Contains("filter of integrated noise: found 1;"));
  CHECK_THROWS_WITH(integrated_noise(-0.1), Catch::Contains("0 or more and below 1"));
  CHECK_THROWS_WITH(autoregressive_noise(v, -1), Catch::Contains("order of an autoregression"));
  CHECK_THROWS_WITH(autoregressive_noise(v, 10), Catch::Contains("found 20 samples; allowed: 30"));
  CHECK_THROWS_WITH(one_step_errors({}, v, v.head(19)), Catch::Contains("20 and 19"));
}
