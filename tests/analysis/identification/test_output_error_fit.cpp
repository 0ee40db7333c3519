#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "analysis/identification/identification.hpp"
#include "analysis/identification/lag_sums.hpp"
#include "analysis/identification/lane_cholesky.hpp"
#include "analysis/identification/model_order.hpp"
#include "analysis/identification/output_error_fit.hpp"
#include "analysis/identification/polynomial_model.hpp"
#include "analysis/identification/prediction_error_fit.hpp"
#include "analysis/identification/prediction_error_options.hpp"
#include "analysis/identification/signal_bank.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::OutputErrorFit;
using mpm::OutputErrorFits;
using mpm::PolynomialModel;
using mpm::SignalBank;
using mpm::testing::noisy_output;
using mpm::testing::random_steps;
using mpm::testing::white_inputs;

namespace {

constexpr double kExact = 1e-11;  // of sums over some hundred numbers of the size of 1

/// Two paths of second order with the direct term, or with a delay.
PolynomialModel second_order_sample(Eigen::Index delay) {
  PolynomialModel model;
  const Eigen::VectorXd direct = Eigen::Vector3d(0.5, 0.3, -0.2);
  const Eigen::VectorXd other = Eigen::Vector3d(-0.4, 0.1, 0.05);
  const Eigen::Index nb = delay == 0 ? 3 : 2;
  model.inputs = {{direct.head(nb), Eigen::Vector3d(1.0, -1.2, 0.5), delay},
                  {other.head(nb), Eigen::Vector3d(1.0, -0.9, 0.3), delay}};
  model.noise_variance = 0.01;
  return model;
}

}  // namespace

TEST_CASE("signal bank: more signals than eight at once are each filtered as one alone is") {
  const Eigen::Index count = 11, samples = 200;
  const Eigen::MatrixXd x = white_inputs(count, samples, 60);
  const Eigen::MatrixXd B = 0.3 * white_inputs(3, count, 61);
  Eigen::MatrixXd F = 0.1 * white_inputs(4, count, 62);
  F.row(0).setOnes();
  SignalBank in(count, samples, 4);
  for (Eigen::Index a = 0; a < count; ++a)
    in[a] = x.row(a).transpose();
  SignalBank out(count, samples, 3);
  filter_bank(B, F, 2, in, out);
  for (Eigen::Index a = 0; a < count; ++a) {
    const Eigen::VectorXd alone = mpm::filter(B.col(a), F.col(a), x.row(a).transpose(), 2);
    CHECK((out[a] - alone).cwiseAbs().maxCoeff() < kExact);
  }
}

TEST_CASE("signal bank: two filters one behind the other, of any order") {
  const Eigen::Index count = 10, samples = 120;
  const Eigen::Index rows = GENERATE(2, 9, 12);  // the last of an order that the kernels do not have
  const Eigen::MatrixXd x = white_inputs(count, samples, 70);
  const Eigen::MatrixXd B = 0.3 * white_inputs(rows, count, 71);
  Eigen::MatrixXd F1 = 0.1 * white_inputs(rows, count, 72), F2 = 0.1 * white_inputs(rows, count, 73);
  F1.row(0).setOnes();
  F2.row(0).setOnes();
  SignalBank in(count, samples, rows), path(count, samples, rows), out(count, samples, rows);
  for (Eigen::Index a = 0; a < count; ++a)
    in[a] = x.row(a).transpose();
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const bool twice = GENERATE(true, false);
  filter_paths(F1, B, twice ? &F2 : nullptr, in, path, out);
  for (Eigen::Index a = 0; a < count; ++a) {
    const Eigen::VectorXd between = mpm::filter(B.col(a), F1.col(a), x.row(a).transpose());
    CHECK((path[a] - between).cwiseAbs().maxCoeff() < kExact);
    const Eigen::VectorXd end =
        twice ? mpm::filter(one, F2.col(a), between) : mpm::filter(one, F1.col(a), x.row(a).transpose());
    CHECK((out[a] - end).cwiseAbs().maxCoeff() < kExact);
  }
}

TEST_CASE("lag sums: products of shifted signals are those of their columns") {
  const Eigen::Index samples = 157;
  const Eigen::Index count = GENERATE(4, 11);  // of one group of eight, and of two
  SignalBank signals(count, samples, 9);
  for (Eigen::Index a = 0; a < count; ++a)
    signals[a] = white_inputs(count, samples, 63).row(a).transpose();
  const Eigen::Index first = GENERATE(0, 3, 9);  // with zeros from before the record, and without
  const std::vector<mpm::LaggedColumns> columns{{0, 1, 5}, {1, 0, 7}, {count - 2, 3, 1}, {0, 2, 7}};
  const Eigen::MatrixXd X = lagged_matrix(signals, columns, first);
  REQUIRE(X.cols() == 20);
  CHECK(X(10, 0) == signals[0](first + 9));
  CHECK(X(0, 4) == (first < 5 ? 0.0 : signals[0](first - 5)));
  mpm::LagSums sums;
  sums.compute(signals, count - 1, 8, first);
  CHECK((sums.products(columns) - X.transpose() * X).cwiseAbs().maxCoeff() < kExact);
  const Eigen::VectorXd x = signals[count - 1].tail(samples - first);  // without columns
  CHECK((sums.products_with(columns, count - 1) - X.transpose() * x).cwiseAbs().maxCoeff() < kExact);
}

TEST_CASE("lag sums: of partners, in both halves of a group of eight") {
  const Eigen::Index samples = 157, first = 6;
  SignalBank signals(16, samples, 9);
  for (Eigen::Index a = 0; a < 16; ++a)
    signals[a] = white_inputs(16, samples, 74).row(a).transpose();
  mpm::LagSums sums;
  sums.compute(signals, 16, 6, first, mpm::LagPairs::partners);
  const Eigen::Index a = GENERATE(0, 3, 10);
  const Eigen::Index delay = GENERATE(0, 1);
  const std::vector<mpm::LaggedColumns> columns{{a, 1, 5}, {a + 4, delay, 6}};
  const Eigen::MatrixXd X = lagged_matrix(signals, columns, first);
  CHECK((sums.products(columns) - X.transpose() * X).cwiseAbs().maxCoeff() < kExact);
  for (const Eigen::Index with : {a, a + 4})
    CHECK((sums.products_with(columns, with) - X.transpose() * signals[with].tail(samples - first))
              .cwiseAbs()
              .maxCoeff() < kExact);
}

TEST_CASE(
    "Cholesky factor by kernels: solves matrices of one size after another, refuses what is not definite") {
  mpm::LaneCholesky factor;
  for (const Eigen::Index n : {5, 5, 8, 13, 3}) {
    CAPTURE(n);
    const Eigen::MatrixXd X = white_inputs(n, 40, static_cast<unsigned>(75 + n));
    const Eigen::MatrixXd S = X * X.transpose();
    const Eigen::VectorXd x = white_inputs(1, n, 76).transpose();
    REQUIRE(factor.compute(S, 0.0));
    CHECK((factor.solve(S * x) - x).cwiseAbs().maxCoeff() < kExact);
    const Eigen::MatrixXd L = S.llt().matrixL();
    CHECK(factor.least_pivot() == Approx(L.diagonal().array().square().minCoeff()));
    Eigen::MatrixXd singular = S;
    singular.col(n - 1) = S.col(0);
    singular.row(n - 1) = singular.col(n - 1).transpose();
    singular(n - 1, n - 1) = S(0, 0);
    CHECK(!factor.compute(singular, 1e-12));
  }
}

TEST_CASE("roots are within a radius when their largest magnitude is below it") {
  int within = 0;
  const Eigen::MatrixXd random = 0.7 * white_inputs(6, 400, 64);
  for (Eigen::Index k = 0; k < random.cols(); ++k) {
    Eigen::VectorXd a = random.col(k).head(2 + k % 5);
    a(0) = 1.0;
    const double radius = k % 2 == 0 ? 1.0 : 0.8;
    CHECK(mpm::has_roots_within(a, radius) == (mpm::root_radius(a) < radius));
    within += mpm::has_roots_within(a, radius) ? 1 : 0;
  }
  CHECK(within > 100);
  CHECK(within < 300);
  CHECK(!mpm::has_roots_within(Eigen::Vector2d(1.0, -1.0), 1.0));
  CHECK(!mpm::has_roots_within(Eigen::Vector2d(1.0, mpm::kNaN), 1.0));
}

TEST_CASE("output-error fits give the coefficients of data without noise back, in any units") {
  const Eigen::Index delay = GENERATE(0, 1);
  const PolynomialModel truth = second_order_sample(delay);
  Eigen::MatrixXd u = random_steps(2, 400, 65);
  const Eigen::VectorXd y = 1e-3 * simulate(truth, u);
  u.row(1) *= 1e4;
  const std::vector<OutputErrorFit> fits = OutputErrorFits(u, 50).fit(y, {2}, delay);
  REQUIRE(fits.size() == 1);
  const PolynomialModel& model = fits[0].model;
  for (std::size_t j = 0; j < 2; ++j) {
    const double unit = j == 0 ? 1e3 : 1e7;
    CHECK((model.inputs[j].B * unit - truth.inputs[j].B).cwiseAbs().maxCoeff() < 1e-7);
    CHECK((model.inputs[j].F - truth.inputs[j].F).cwiseAbs().maxCoeff() < 1e-7);
    CHECK(model.inputs[j].delay == delay);
  }
  CHECK(fits[0].loss < 1e-16 * y.squaredNorm());
}

TEST_CASE("output-error fits end where the search over an orthogonal factorisation ends") {
  const Eigen::Index delay = GENERATE(0, 1);
  const PolynomialModel truth = second_order_sample(delay);
  const Eigen::MatrixXd u = random_steps(2, 500, 66);
  const Eigen::VectorXd y = noisy_output(truth, u, 67);
  mpm::PredictionErrorOptions options;
  options.max_iterations = GENERATE(1, 100);  // the same steps, and the same minimum
  options.max_starts = 1;
  const Eigen::Index nb = delay == 0 ? 3 : 2;
  const mpm::Identification slow =
      identify_prediction_error(y, u, mpm::output_error_order(2, nb, 2, delay), options);
  const OutputErrorFit fast = OutputErrorFits(u, options.max_iterations).fit(y, {1, 2, 3}, delay)[1];
  CHECK(fast.loss == Approx(slow.loss).epsilon(1e-10));
  // Starts differ by rounding, minima by the tolerance of the search.
  CHECK((fast.model.parameters() - slow.model.parameters()).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(fast.loss == Approx(prediction_errors(fast.model, y, u).squaredNorm() / 500.0));
}

TEST_CASE("output-error fits of more inputs, and of a higher order, than fit side by side") {
  const bool many = GENERATE(true, false);
  const Eigen::Index nu = many ? 5 : 1, order = many ? 1 : 9;
  const Eigen::MatrixXd u = white_inputs(nu, 600, 77);
  PolynomialModel truth;
  for (Eigen::Index j = 0; j < nu; ++j) {
    const double pole = 0.3 + 0.1 * static_cast<double>(j);
    truth.inputs.push_back({Eigen::VectorXd::Constant(1, 1.0), Eigen::Vector2d(1.0, -pole), 1});
  }
  truth.noise_variance = 0.01;
  const Eigen::VectorXd y = noisy_output(truth, u, 78);
  mpm::PredictionErrorOptions options;
  options.max_iterations = 1;
  options.max_starts = 1;
  const mpm::Identification slow =
      identify_prediction_error(y, u, mpm::output_error_order(nu, order, order, 1), options);
  const OutputErrorFit fast = OutputErrorFits(u, options.max_iterations).fit(y, {order}, 1).front();
  CHECK(fast.loss == Approx(slow.loss).epsilon(1e-9));
  CHECK((fast.model.parameters() - slow.model.parameters()).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("output-error fits start from ARX models longer than those of every order") {
  // 5 x 6 = 30 coefficients an input, above 25. What is read before the memory of the inputs is refused.
  const Eigen::MatrixXd u = white_inputs(5, 600, 77);
  PolynomialModel truth;
  for (Eigen::Index j = 0; j < 5; ++j)
    truth.inputs.push_back({Eigen::VectorXd::Constant(1, 1.0), Eigen::Vector2d(1.0, -0.3), 1});
  truth.noise_variance = 0.01;
  const std::vector<OutputErrorFit> fits = OutputErrorFits(u, 20).fit(noisy_output(truth, u, 78), {1, 6}, 1);
  CHECK(fits[0].loss == Approx(0.01).epsilon(0.15));
  CHECK(fits[1].loss < fits[0].loss);
  CHECK(fits[1].loss == Approx(0.01).epsilon(0.15));
}

TEST_CASE("signal bank: a filter longer than its memory is refused") {
  mpm::SignalBank in(1, 10, 1), out(1, 10, 1);
  CHECK_THROWS_AS(filter_bank(Eigen::MatrixXd::Ones(3, 1), Eigen::MatrixXd::Ones(1, 1), 0, in, out),
                  std::logic_error);
  CHECK_THROWS_AS(filter_bank(Eigen::MatrixXd::Ones(2, 1), Eigen::MatrixXd::Ones(3, 1), 0, in, out),
                  std::logic_error);
  CHECK_THROWS_AS(mpm::LagSums().compute(in, 1, 3, 1), std::logic_error);
}

TEST_CASE(
    "output-error fits bear inputs that depend on each other, and refuse what no model can be found from") {
  Eigen::MatrixXd u = random_steps(2, 300, 68);
  u.row(1) = 2.0 * u.row(0);
  const Eigen::VectorXd y = simulate(second_order_sample(1), u);
  mpm::PredictionErrorOptions options;
  options.max_iterations = 20;
  options.max_starts = 1;
  const mpm::Identification slow =
      identify_prediction_error(y, u, mpm::output_error_order(2, 2, 2, 1), options);
  const OutputErrorFit fit = OutputErrorFits(u, 20).fit(y, {2}, 1).front();
  CHECK(fit.loss < 0.01 * y.squaredNorm() / 300.0);  // %Fit above 90
  CHECK(fit.loss == Approx(slow.loss).epsilon(0.01));
  CHECK_THROWS_AS(OutputErrorFits(u, 20).fit(y.head(200), {3}, 1), mpm::InputError);
  CHECK_THROWS_AS(OutputErrorFits(u.leftCols(12), 20).fit(y.head(12), {3}, 1), mpm::InputError);
  Eigen::VectorXd missing = y;
  missing(7) = mpm::kNaN;
  CHECK_THROWS_AS(OutputErrorFits(u, 20).fit(missing, {3}, 1), mpm::InputError);
}
