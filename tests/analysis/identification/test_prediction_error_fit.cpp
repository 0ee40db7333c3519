#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/identification/prediction_error.hpp"
#include "analysis/identification/prediction_error_fit.hpp"
#include "analysis/identification/prediction_error_search.hpp"
#include "analysis/identification/prediction_error_start.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::box_jenkins_order;
using mpm::Identification;
using mpm::IdentificationStatus;
using mpm::identify_prediction_error;
using mpm::output_error_order;
using mpm::PolynomialModel;
using mpm::PredictionErrorOptions;
using mpm::StartState;
using mpm::testing::box_jenkins_sample;
using mpm::testing::noisy_output;
using mpm::testing::output_error_sample;
using mpm::testing::parameter_distance;
using mpm::testing::random_steps;
using mpm::testing::white_noise;

namespace {

/// Largest cosine of the angle between e and the gradient of one coefficient: 0 at a minimum, by a route of
/// its own.
double offset(const Identification& fit, const Eigen::VectorXd& y, const Eigen::MatrixXd& u) {
  const Eigen::MatrixXd J = prediction_error_gradient(fit.model, y, u);
  const Eigen::VectorXd e = prediction_errors(fit.model, y, u);
  return (J.transpose() * e).cwiseAbs().cwiseQuotient(J.colwise().norm().transpose()).maxCoeff() / e.norm();
}

}  // namespace

TEST_CASE("output error: data without noise give the coefficients back") {
  const PolynomialModel truth = output_error_sample();
  const Eigen::MatrixXd u = random_steps(2, 300, 30);
  const Identification fit = identify_prediction_error(simulate(truth, u), u, truth.order());
  CHECK(fit.status == IdentificationStatus::ok);
  CHECK(parameter_distance(fit.model, truth) < 1e-9);  // eps times the condition of the regressors
}

TEST_CASE("Box-Jenkins: data without noise give the response back and leave C and D at 1") {
  PolynomialModel truth = box_jenkins_sample();
  truth.C = truth.D = Eigen::VectorXd::Ones(1);
  const Eigen::MatrixXd u = random_steps(1, 300, 31);
  const Identification fit =
      identify_prediction_error(simulate(truth, u), u, box_jenkins_order(1, 2, 2, 1, 1, 2));
  CHECK(fit.status == IdentificationStatus::noise_free);
  CHECK((fit.model.parameters().head(4) - truth.parameters()).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(fit.model.parameters().tail(2).isZero());
  CHECK(fit.covariance.bottomRows(2).isZero());
}

TEST_CASE("a fit ends at a minimum of the loss, in both families") {
  const PolynomialModel truth = GENERATE(output_error_sample(), box_jenkins_sample());
  const auto nu = static_cast<Eigen::Index>(truth.inputs.size());
  const Eigen::MatrixXd u = random_steps(nu, 600, 32);
  const Eigen::VectorXd y = noisy_output(truth, u, 33);
  const Identification fit = identify_prediction_error(y, u, truth.order());
  REQUIRE(fit.status == IdentificationStatus::ok);
  CHECK(offset(fit, y, u) < 1e-4);
  // Nothing nearby is better.
  const Eigen::VectorXd theta = fit.model.parameters();
  const Eigen::VectorXd error = fit.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < theta.size(); ++i)
    for (const double sign : {-1.0, 1.0}) {
      Eigen::VectorXd moved = theta;
      moved(i) += sign * 0.1 * error(i);
      const PolynomialModel other = model_from_parameters(truth.order(), moved);
      CHECK(prediction_errors(other, y, u).squaredNorm() > 600.0 * fit.loss);
    }
  CHECK(fit.loss <= prediction_errors(truth, y, u).squaredNorm() / 600.0);
}

TEST_CASE("starts are stable, the best one comes first, and it is near the minimum already") {
  const PolynomialModel truth = GENERATE(output_error_sample(), box_jenkins_sample());
  const auto nu = static_cast<Eigen::Index>(truth.inputs.size());
  const Eigen::MatrixXd u = random_steps(nu, 600, 47);
  const Eigen::VectorXd y = noisy_output(truth, u, 48);
  const PredictionErrorOptions options;
  const std::vector<PolynomialModel> starts = prediction_error_starts(y, u, truth.order(), options);
  REQUIRE(starts.size() > 1);
  double before = 0.0;
  for (const PolynomialModel& start : starts) {
    CHECK(start.order() == truth.order());
    CHECK(mpm::search_radius(start) < options.largest_radius);
    const double sum = prediction_errors(start, y, u).squaredNorm();
    CHECK(sum >= before);
    before = sum;
  }
  // An estimate that is consistent, if not efficient: some standard errors, p/N = 1 % of the loss each
  // squared.
  CHECK(prediction_errors(starts.front(), y, u).squaredNorm() <
        1.1 * prediction_errors(truth, y, u).squaredNorm());
}

TEST_CASE("a fit is the same, bit for bit, when it is made again") {
  const PolynomialModel truth = box_jenkins_sample();
  const Eigen::MatrixXd u = random_steps(1, 400, 34);
  const Eigen::VectorXd y = noisy_output(truth, u, 35);
  const Identification first = identify_prediction_error(y, u, truth.order());
  const Identification second = identify_prediction_error(y, u, truth.order());
  CHECK(first.model.parameters() == second.model.parameters());
  CHECK(first.covariance == second.covariance);
}

TEST_CASE("coefficients change with the units of the signals as they must") {
  const PolynomialModel truth = box_jenkins_sample();
  const Eigen::MatrixXd u = random_steps(1, 400, 36);
  const Eigen::VectorXd y = noisy_output(truth, u, 37);
  const Identification fit = identify_prediction_error(y, u, truth.order());
  const Identification other = identify_prediction_error(1e-5 * y, 1e3 * u, truth.order());
  REQUIRE(other.status == IdentificationStatus::ok);
  // Both searches end within 1e-4 sqrt(400) standard errors of the minimum, in fact much nearer.
  const Eigen::VectorXd error = fit.covariance.diagonal().cwiseSqrt();
  CHECK((other.model.inputs[0].B * 1e8 - fit.model.inputs[0].B).cwiseAbs().maxCoeff() < 1e-4 * error(0));
  CHECK((other.model.inputs[0].F - fit.model.inputs[0].F).cwiseAbs().maxCoeff() < 1e-4 * error(2));
}

TEST_CASE("a record that begins in another steady state needs to be told so") {
  const PolynomialModel truth = output_error_sample();
  const Eigen::MatrixXd u = random_steps(2, 300, 38).array() + 3.0;
  const Eigen::VectorXd y = simulate(truth, u, StartState::held);
  PredictionErrorOptions options;
  options.start = StartState::held;
  CHECK(parameter_distance(identify_prediction_error(y, u, truth.order(), options).model, truth) < 1e-9);
  options.start = StartState::rest;
  CHECK(parameter_distance(identify_prediction_error(y, u, truth.order(), options).model, truth) > 1e-2);
  // Or the samples that remember the start are left out: the roots of F are 0.8 and below, 0.8^120 = 2e-12.
  options.first_sample = 120;
  CHECK(parameter_distance(identify_prediction_error(y, u, truth.order(), options).model, truth) < 1e-7);
}

TEST_CASE("every model found is stable, also for an output that is not") {
  const Eigen::MatrixXd u = random_steps(1, 200, 39);
  PolynomialModel growing = box_jenkins_sample();
  growing.inputs[0].F = Eigen::Vector2d(1.0, -1.02);
  const Eigen::VectorXd y = noisy_output(growing, u, 40);
  const PredictionErrorOptions options;
  const Identification fit = identify_prediction_error(y, u, box_jenkins_order(1, 2, 1, 1, 1, 2), options);
  CHECK(std::isfinite(fit.loss));
  CHECK(mpm::search_radius(fit.model) <= options.largest_radius);
}

TEST_CASE("a noise that drifts ends at the stability limit") {
  PolynomialModel truth = box_jenkins_sample();
  truth.C = Eigen::VectorXd::Ones(1);
  truth.D = Eigen::Vector2d(1.0, -1.0);
  const Eigen::MatrixXd u = random_steps(1, 400, 41);
  PredictionErrorOptions options;
  options.largest_radius = 0.95;
  const Identification fit =
      identify_prediction_error(noisy_output(truth, u, 42), u, box_jenkins_order(1, 2, 2, 0, 1, 2), options);
  CHECK(fit.status == IdentificationStatus::at_stability_limit);
  CHECK(is_usable(fit.status));
  // The response to the input survives a noise model that is not quite right.
  CHECK((step_response(fit.model, 50) - step_response(truth, 50)).cwiseAbs().maxCoeff() < 0.5);
}

TEST_CASE("data that do not determine a model are a status") {
  const PolynomialModel truth = output_error_sample();
  const Eigen::MatrixXd u = random_steps(2, 200, 43);
  const Eigen::VectorXd y = noisy_output(truth, u, 44);
  SECTION("collinear inputs") {
    Eigen::MatrixXd twice(2, 200);
    twice << u.row(0), 2.0 * u.row(0);
    CHECK(identify_prediction_error(y, twice, output_error_order(2, 2, 1)).status ==
          IdentificationStatus::rank_deficient);
  }
  SECTION("an input that is 0") {
    CHECK(identify_prediction_error(y, Eigen::MatrixXd::Zero(1, 200), output_error_order(1, 2, 1)).status ==
          IdentificationStatus::rank_deficient);
  }
  SECTION("an input that is constant from a steady state on") {
    PredictionErrorOptions options;
    options.start = StartState::held;
    const Eigen::MatrixXd constant = Eigen::MatrixXd::Constant(1, 200, 1.0);
    CHECK(identify_prediction_error(y, constant, box_jenkins_order(1, 2, 1, 1, 1), options).status ==
          IdentificationStatus::rank_deficient);
  }
  SECTION("an output that is 0") {
    CHECK(identify_prediction_error(Eigen::VectorXd::Zero(200), u, output_error_order(2, 2, 1)).status ==
          IdentificationStatus::rank_deficient);
  }
}

TEST_CASE("orders above those of data without noise leave the coefficients open, and not the response") {
  PolynomialModel truth = box_jenkins_sample();
  truth.C = truth.D = Eigen::VectorXd::Ones(1);
  Eigen::MatrixXd u = random_steps(1, 200, 45);
  u(0, 0) = 0.0;
  const Eigen::VectorXd y = simulate(truth, u, StartState::rest);
  const mpm::ModelOrder high = box_jenkins_order(1, 8, 6, 1, 1);
  const Identification fit = identify_prediction_error(y, u, high);
  CHECK(fit.status == IdentificationStatus::noise_free);
  CHECK(fit.covariance.size() == 0);
  // Rounding of the data, through an ill-conditioned search.
  CHECK((step_response(fit.model, 100) - step_response(truth, 100)).cwiseAbs().maxCoeff() < 1e-6);
  // Of two inputs that move together the responses are open, however exact the model is.
  Eigen::MatrixXd twice(2, 200);
  twice << u, 2.0 * u;
  CHECK(identify_prediction_error(y, twice, box_jenkins_order(2, 4, 2, 1, 1)).status ==
        IdentificationStatus::rank_deficient);
}

TEST_CASE("with one start allowed the search from the best one is all there is") {
  // A noise that drifts ends at the stability limit from every start, so that all of them are tried.
  const Eigen::MatrixXd u = random_steps(1, 400, 47);
  Eigen::VectorXd y = white_noise(400, 48);
  for (Eigen::Index k = 1; k < y.size(); ++k)
    y(k) += y(k - 1);
  const mpm::ModelOrder order = box_jenkins_order(1, 2, 2, 1, 1);
  PredictionErrorOptions options;
  const Identification all = identify_prediction_error(y, u, order, options);
  options.max_starts = 1;
  const Identification first = identify_prediction_error(y, u, order, options);
  CHECK(first.loss >= all.loss);
  const auto starts = mpm::prediction_error_starts(y, u, order, options);
  REQUIRE(starts.size() > 1);
  CHECK(first.model.parameters() == mpm::search_prediction_error(starts[0], y, u, options).parameters());
}

TEST_CASE("an identification refuses what cannot be meant") {
  const Eigen::MatrixXd u = random_steps(1, 20, 45);
  const Eigen::VectorXd y = white_noise(20, 46);
  CHECK_THROWS_WITH(identify_prediction_error(y.head(5), u.leftCols(5), box_jenkins_order(1, 2, 2, 1, 1)),
                    Catch::Contains("found 5 samples; allowed: 7"));
  CHECK_THROWS_WITH(identify_prediction_error(y, u, mpm::testing::arx_order(1, 1, 1)),
                    Catch::Contains("na 0"));
  CHECK_THROWS_WITH(identify_prediction_error(y, u, output_error_order(1, 0, 1)),
                    Catch::Contains("coefficients of B of input 0: found 0"));
  PredictionErrorOptions options;
  options.largest_radius = 1.0;
  CHECK_THROWS_WITH(identify_prediction_error(y, u, output_error_order(1, 1, 1), options),
                    Catch::Contains("largest radius"));
  options = {};
  options.max_starts = 0;
  CHECK_THROWS_WITH(identify_prediction_error(y, u, output_error_order(1, 1, 1), options),
                    Catch::Contains("number of starts: found 0"));
  options = {};
  options.first_sample = 18;
  CHECK_THROWS_WITH(identify_prediction_error(y, u, output_error_order(1, 1, 1), options),
                    Catch::Contains("allowed: 21 or more"));
  CHECK_NOTHROW(identify(y, u, mpm::testing::arx_order(1, 1, 1)));
}
