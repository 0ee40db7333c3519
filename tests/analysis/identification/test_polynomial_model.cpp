#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "analysis/identification/polynomial_model.hpp"
#include "analysis/identification/prediction_error.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::PolynomialModel;
using mpm::StartState;
using mpm::testing::random_steps;
using mpm::testing::simulate_noisy;
using mpm::testing::white_noise;

namespace {

// Sums of a few thousand products of size 1.
constexpr double kRounding = 1e-11;

/// A model in which no polynomial is 1.
PolynomialModel full_model() {
  PolynomialModel model = mpm::testing::output_error_sample();
  model.A = Eigen::Vector2d(1.0, -0.4);
  model.C = Eigen::Vector3d(1.0, 0.5, 0.2);
  model.D = Eigen::Vector2d(1.0, -0.7);
  return model;
}

double largest(const Eigen::VectorXd& x) {
  return x.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a filter obeys its difference equation") {
  const Eigen::Vector3d b(0.5, -0.2, 0.1);
  const Eigen::Vector3d a(1.0, -1.1, 0.4);
  const Eigen::VectorXd x = white_noise(60, 1);
  const Eigen::VectorXd y = mpm::filter(b, a, x, 2);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    double residual = 0.0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      residual += k >= i ? a(i) * y(k - i) : 0.0;
      residual -= k >= i + 2 ? b(i) * x(k - i - 2) : 0.0;
    }
    CHECK(std::abs(residual) < kRounding);
  }
}

TEST_CASE("a filter and its inverse give the signal back, from rest and held") {
  const Eigen::Vector2d b(1.0, -0.3);
  const Eigen::Vector3d a(1.0, -0.9, 0.3);
  const Eigen::VectorXd x = white_noise(200, 2).array() + 4.0;
  for (const StartState start : {StartState::rest, StartState::held})
    CHECK(largest(mpm::filter(a, b, mpm::filter(b, a, x, 0, start), 0, start) - x) < kRounding);
}

TEST_CASE("a held filter continues what a long constant record before it would give") {
  const Eigen::Vector2d b(0.3, 0.1);
  const Eigen::Vector2d a(1.0, -0.8);
  const Eigen::VectorXd x = white_noise(50, 3).array() + 2.0;
  Eigen::VectorXd longer(250);
  longer << Eigen::VectorXd::Constant(200, x(0)), x;  // 0.8^200 = 4e-20
  const Eigen::VectorXd y = mpm::filter(b, a, x, 3, StartState::held);
  CHECK(largest(y - mpm::filter(b, a, longer, 3).tail(50)) < kRounding);
}

TEST_CASE("the root radius is that of the eigenvalues, and stabilised roots keep the amplitude response") {
  // Roots 1.25 exp(+-i) and 0.5: two outside, reflected to 0.8 exp(+-i).
  const double p = -2.0 * 1.25 * std::cos(1.0);
  const Eigen::Vector4d a(1.0, p - 0.5, 1.5625 - 0.5 * p, -0.5 * 1.5625);
  CHECK(mpm::root_radius(a) == Approx(1.25).epsilon(1e-12));
  const Eigen::VectorXd stable = mpm::stabilised(a, 0.999);
  CHECK(mpm::root_radius(stable) == Approx(0.8).epsilon(1e-12));
  for (const double frequency : {0.1, 1.0, 2.5}) {
    std::complex<double> before = 0.0;
    std::complex<double> after = 0.0;
    for (Eigen::Index i = 0; i < 4; ++i) {
      const std::complex<double> shift = std::polar(1.0, -frequency * static_cast<double>(i));
      before += a(i) * shift;
      after += stable(i) * shift;
    }
    CHECK(std::abs(before) / std::abs(after) == Approx(1.25 * 1.25).epsilon(1e-10));
  }
  CHECK(mpm::root_radius(mpm::stabilised(Eigen::Vector2d(1.0, -1.0), 0.9)) == Approx(0.9));
}

TEST_CASE("prediction errors are the innovations that made the output") {
  const PolynomialModel model = full_model();
  const Eigen::MatrixXd u = random_steps(2, 400, 4);
  const Eigen::VectorXd e = white_noise(400, 5);
  const Eigen::VectorXd y = simulate_noisy(model, u, e);
  CHECK(largest(prediction_errors(model, y, u) - e) < kRounding);
  // A prediction of y(k) must not know y(k) or anything later.
  Eigen::VectorXd changed = y;
  changed.tail(100).array() += 7.0;
  const Eigen::VectorXd y_hat = changed - prediction_errors(model, changed, u);
  CHECK(largest(y_hat.head(301) - (y - e).head(301)) < kRounding);
}

TEST_CASE("a held model stands still, and departs as from rest") {
  const PolynomialModel model = full_model();
  Eigen::MatrixXd u = Eigen::MatrixXd::Constant(2, 100, 1.5);
  const Eigen::VectorXd still = simulate(model, u, StartState::held);
  CHECK(largest(still.array() - still(0)) < kRounding);
  u.rightCols(60).array() += 1.0;
  const Eigen::MatrixXd change = u.array() - 1.5;
  CHECK(largest(simulate(model, u, StartState::held) - still - simulate(model, change)) < kRounding);
}

TEST_CASE("a step response is the simulated step, and ends at the static gain") {
  const PolynomialModel model = mpm::testing::output_error_sample();
  const Eigen::MatrixXd response = step_response(model, 300);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(2, 301);
  u.row(1).setOnes();
  CHECK(largest(simulate(model, u).tail(300) - response.row(1).transpose()) < kRounding);
  CHECK(response(1, 1) == 0.0);  // a delay of 3 samples
  CHECK(response(1, 2) == -0.4);
  CHECK(response(0, 299) == Approx(0.8 / 0.3));
  CHECK(response(1, 299) == Approx(-0.4 / 0.2));
}

TEST_CASE("coefficients go into a model and come out in the same order") {
  const PolynomialModel model = full_model();
  CHECK(model_from_parameters(model.order(), model.parameters()).parameters() == model.parameters());
  CHECK(model.order().to_string() == "na 1 nb [2, 1] nf [2, 1] nc 2 nd 1 delay [1, 3]");
  CHECK_THROWS_WITH(model_from_parameters(model.order(), Eigen::VectorXd::Zero(3)),
                    Catch::Contains("found 3; allowed: 10"));
}

TEST_CASE("the gradient of the prediction errors agrees with central differences") {
  const PolynomialModel model = full_model();
  const Eigen::MatrixXd u = random_steps(2, 150, 6).array() + 0.5;
  const Eigen::VectorXd y = simulate_noisy(model, u, white_noise(150, 7)).array() + 0.3;
  const StartState start = GENERATE(StartState::rest, StartState::held);
  const Eigen::VectorXd theta = model.parameters();
  const Eigen::MatrixXd gradient = prediction_error_gradient(model, y, u, start);
  REQUIRE(gradient.cols() == theta.size());
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double h = 1e-5;
    Eigen::VectorXd above = theta;
    Eigen::VectorXd below = theta;
    above(i) += h;
    below(i) -= h;
    const Eigen::VectorXd difference =
        (prediction_errors(model_from_parameters(model.order(), above), y, u, start) -
         prediction_errors(model_from_parameters(model.order(), below), y, u, start)) /
        (2.0 * h);
    // Truncation h^2 = 1e-10 and rounding 1e-16/h = 1e-11, times third derivatives of up to some hundreds.
    CHECK(largest(gradient.col(i) - difference) < 1e-6 * (1.0 + largest(difference)));
  }
}

TEST_CASE("models and signals that do not fit are refused") {
  PolynomialModel model = full_model();
  const Eigen::MatrixXd u = random_steps(2, 20, 8);
  CHECK_THROWS_WITH(simulate(model, u.topRows(1)), Catch::Contains("rows of u: found 1; allowed: 2"));
  CHECK_THROWS_WITH(prediction_errors(model, Eigen::VectorXd::Zero(19), u), Catch::Contains("length of y"));
  model.inputs[1].F(0) = 2.0;
  CHECK_THROWS_WITH(simulate(model, u), Catch::Contains("first coefficient of F of input 1: found 2"));
  model.inputs[1].F = Eigen::Vector2d(1.0, -1.0);
  CHECK_THROWS_WITH(simulate(model, u, StartState::held), Catch::Contains("root at 1"));
  CHECK_THROWS_AS(step_response(model, 0), mpm::InputError);
}
