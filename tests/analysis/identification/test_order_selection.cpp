#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/identification/order_selection.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::OrderCriterion;
using mpm::OrderGrid;
using mpm::OrderSelection;
using mpm::OrderSelectionOptions;
using mpm::percent_fit;
using mpm::PolynomialModel;
using mpm::testing::noisy_output;

TEST_CASE("%Fit is 100 for the measurement itself, 0 for its mean, and halves with the error") {
  const Eigen::VectorXd y = mpm::testing::white_noise(200, 50).array() + 3.0;
  CHECK(percent_fit(y, y) == 100.0);
  CHECK(percent_fit(y, Eigen::VectorXd::Constant(200, y.mean())) == Approx(0.0).margin(1e-12));
  const Eigen::VectorXd half = 0.5 * (y.array() + y.mean());
  CHECK(percent_fit(y, half) == Approx(50.0));
  CHECK(std::isnan(percent_fit(Eigen::VectorXd::Ones(5), y.head(5))));
  const double infinity = mpm::kInfinity;
  CHECK(percent_fit(y, Eigen::VectorXd::Constant(200, infinity)) == -infinity);
  CHECK_THROWS_AS(percent_fit(y, y.head(5)), mpm::InputError);
}

TEST_CASE("a grid is all combinations, and refuses an empty list") {
  OrderGrid grid;
  grid.nb = {1, 2};
  grid.nf = {1, 2, 3};
  grid.delay = {1, 4};
  const std::vector<mpm::ModelOrder> candidates = order_candidates(grid, 2);
  CHECK(candidates.size() == 12);
  CHECK(candidates.back() == mpm::output_error_order(2, 2, 3, 4));
  grid.nd.clear();
  CHECK_THROWS_WITH(order_candidates(grid, 2), Catch::Contains("values of nd"));
}

TEST_CASE("the right orders and delay are chosen by every criterion that promises it") {
  const PolynomialModel truth = mpm::testing::box_jenkins_sample();  // nb 2, nf 2, delay 2
  // A white input: one that is held tells a delay hardly from another numerator.
  const Eigen::MatrixXd u = mpm::testing::white_inputs(1, 1200, 51);
  const Eigen::VectorXd y = noisy_output(truth, u, 52);
  OrderGrid grid;
  grid.nf = {1, 2, 3};
  grid.nc = {1};
  grid.nd = {1};
  grid.delay = {1, 2, 3};
  OrderSelectionOptions options;
  options.criterion = GENERATE(OrderCriterion::bic, OrderCriterion::aic, OrderCriterion::validation_loss,
                               OrderCriterion::validation_fit);
  const OrderSelection selection = select_order(y, u, order_candidates(grid, 1), options);
  REQUIRE(selection.best);
  const mpm::OrderCandidate& best = selection.candidates[*selection.best];
  CAPTURE(best.order.to_string());
  CHECK(best.order.inputs[0].delay == 2);
  CHECK(best.order.inputs[0].nf >= 2);
  if (options.criterion == OrderCriterion::bic)
    CHECK(best.order.inputs[0].nf == 2);
  // What the criteria are, from their definitions.
  const auto n = static_cast<double>(best.identification.samples);
  const auto p = static_cast<double>(best.order.parameter_count());
  CHECK(n == 840.0);
  CHECK(best.aic == Approx(n * std::log(best.identification.loss) + 2.0 * p));
  CHECK(best.bic - best.aic == Approx(p * (std::log(n) - 2.0)));
  const PolynomialModel& model = best.identification.model;
  CHECK(best.validation_fit == Approx(percent_fit(y.tail(360), simulate(model, u).tail(360))));
  CHECK(best.validation_loss == Approx(prediction_errors(model, y, u).tail(360).squaredNorm() / 360.0));
}

TEST_CASE("of models that are all exact the smallest is chosen") {
  PolynomialModel truth = mpm::testing::arx_sample();
  const Eigen::MatrixXd u = mpm::testing::random_steps(1, 400, 53);
  OrderGrid grid;
  grid.na = {1, 2};
  grid.nb = {1, 2, 4};
  const OrderSelection selection = select_order(simulate(truth, u), u, order_candidates(grid, 1));
  REQUIRE(selection.best);
  CHECK(selection.candidates[*selection.best].order == truth.order());
  for (const mpm::OrderCandidate& candidate : selection.candidates)
    CHECK(candidate.identification.first_sample == 4);  // the same samples for all
}

TEST_CASE("no model is chosen when none can be had, and bad options are refused") {
  const Eigen::VectorXd y = mpm::testing::white_noise(100, 54);
  const std::vector<mpm::ModelOrder> candidates = {mpm::output_error_order(1, 1, 1)};
  CHECK_FALSE(select_order(y, Eigen::MatrixXd::Zero(1, 100), candidates).best);
  OrderSelectionOptions options;
  options.validation_share = 1.0;
  CHECK_THROWS_WITH(select_order(y, y.transpose(), candidates, options), Catch::Contains("validation share"));
  CHECK_THROWS_WITH(mpm::select_order(y, y.transpose(), {}), Catch::Contains("orders to select from"));
}
