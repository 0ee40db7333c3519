#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/identification/arx.hpp"
#include "analysis/methods/literature/high_order_arx.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::ArxOutputs;
using mpm::HighOrderArx;
using mpm::HighOrderArxOptions;
using mpm::Identification;
using mpm::identify_arx;
using mpm::identify_high_order_arx;
using mpm::ModelOrder;
using mpm::OrderCriterion;
using mpm::testing::random_steps;
using mpm::testing::white_inputs;

namespace {

/// Two coupled outputs that follow two references, with unit innovations.
Eigen::MatrixXd coupled_outputs(const Eigen::MatrixXd& r, std::uint64_t number) {
  const Eigen::MatrixXd e = white_inputs(2, r.cols(), number);
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(2, r.cols());
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    y.col(k) = e.col(k);
    if (k >= 2) {
      y(0, k) += 0.6 * y(0, k - 1) - 0.2 * y(1, k - 2) + 0.4 * r(0, k - 1);
      y(1, k) += 0.3 * y(0, k - 1) + 0.5 * y(1, k - 1) + 0.7 * r(1, k - 2);
    }
  }
  return y;
}

/// The same regression by the single-output identification: other outputs, references and the constant are
/// inputs.
Identification by_arx(const Eigen::MatrixXd& y, const Eigen::MatrixXd& r, Eigen::Index cv, bool others,
                      Eigen::Index order, Eigen::Index first) {
  Eigen::MatrixXd u(r.rows() + 1 + (others ? y.rows() - 1 : 0), y.cols());
  u.topRows(r.rows()) = r;
  u.row(r.rows()).setOnes();
  ModelOrder orders = mpm::testing::arx_order(u.rows(), order, order);
  orders.inputs[static_cast<std::size_t>(r.rows())].nb = 1;
  Eigen::Index next = r.rows() + 1;
  for (Eigen::Index i = 0; others && i < y.rows(); ++i)
    if (i != cv)
      u.row(next++) = y.row(i);
  return identify_arx(y.row(cv).transpose(), u, orders, {first, 1e-10});
}

HighOrderArxOptions of_orders(std::vector<Eigen::Index> orders, ArxOutputs outputs = ArxOutputs::all) {
  HighOrderArxOptions options;
  options.orders = std::move(orders);
  options.outputs = outputs;
  return options;
}

}  // namespace

TEST_CASE("high-order ARX: the sums of squares are those of single-output regressions") {
  const Eigen::MatrixXd r = random_steps(2, 400, 310);
  const Eigen::MatrixXd y = coupled_outputs(r, 311);
  for (const ArxOutputs outputs : {ArxOutputs::all, ArxOutputs::own}) {
    const HighOrderArx fit = identify_high_order_arx(y, r, of_orders({4}, outputs));
    CHECK(fit.first_sample == 4);
    REQUIRE(fit.e_d.cols() == 396);
    for (Eigen::Index cv = 0; cv < 2; ++cv) {
      const Identification arx = by_arx(y, r, cv, outputs == ArxOutputs::all, 4, 4);
      CHECK(fit.e_d.row(cv).squaredNorm() == Approx(arx.loss * 396.0).epsilon(1e-10));
      CHECK(fit.parameters[static_cast<std::size_t>(cv)] == (outputs == ArxOutputs::all ? 17 : 13));
    }
  }
}

TEST_CASE("high-order ARX: a loop without innovations leaves nothing") {
  const Eigen::MatrixXd r = random_steps(2, 200, 312);
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(2, 200);
  for (Eigen::Index k = 1; k < 200; ++k) {
    y(0, k) = 0.5 * y(0, k - 1) + 0.2 * y(1, k - 1) + 0.5 * r(0, k - 1) + 1.0;
    y(1, k) = -0.3 * y(0, k - 1) + 0.4 * r(1, k - 1);
  }
  // Rounding of outputs near 1.
  CHECK(identify_high_order_arx(y, r, of_orders({1})).e_d.cwiseAbs().maxCoeff() < 1e-12);
  HighOrderArxOptions without_constant = of_orders({1});
  without_constant.constant = false;
  CHECK(identify_high_order_arx(y, r, without_constant).e_d.row(0).norm() > 1e-3);
}

TEST_CASE("high-order ARX: AIC, BIC and validation choose what separate regressions choose") {
  const Eigen::MatrixXd r = random_steps(2, 500, 313);
  const Eigen::MatrixXd y = coupled_outputs(r, 314);
  const std::vector<Eigen::Index> candidates{1, 2, 3, 5, 8};
  const double n = 492.0;
  for (const OrderCriterion criterion :
       {OrderCriterion::aic, OrderCriterion::bic, OrderCriterion::validation_loss}) {
    HighOrderArxOptions options = of_orders(candidates);
    options.criterion = criterion;
    const HighOrderArx fit = identify_high_order_arx(y, r, options);
    CHECK(fit.first_sample == 8);
    for (Eigen::Index cv = 0; cv < 2; ++cv) {
      double lowest = mpm::kInfinity;
      Eigen::Index best = 0;
      for (const Eigen::Index order : candidates) {
        const double p = 4.0 * static_cast<double>(order) + 1.0;
        double score = 0.0;
        if (criterion == OrderCriterion::validation_loss) {
          // The first 70 % of the samples after the longest memory estimate, the rest is predicted.
          const Eigen::Index estimation = 8 + 344;
          const Identification arx =
              by_arx(y.leftCols(estimation), r.leftCols(estimation), cv, true, order, 8);
          Eigen::MatrixXd u(4, 500);
          u << r, Eigen::RowVectorXd::Ones(500), y.row(1 - cv);
          score = prediction_errors(arx.model, y.row(cv).transpose(), u).tail(148).squaredNorm();
        } else {
          const double loss = by_arx(y, r, cv, true, order, 8).loss;
          score = n * std::log(loss) + p * (criterion == OrderCriterion::aic ? 2.0 : std::log(n));
        }
        if (score < lowest) {
          lowest = score;
          best = order;
        }
      }
      CHECK(fit.orders[static_cast<std::size_t>(cv)] == best);
    }
  }
}

TEST_CASE("high-order ARX: the order of the references can differ from that of the outputs") {
  const Eigen::MatrixXd r = random_steps(2, 300, 315);
  const Eigen::MatrixXd y = coupled_outputs(r, 316);
  HighOrderArxOptions options = of_orders({2});
  options.input_order = 5;
  const HighOrderArx fit = identify_high_order_arx(y, r, options);
  CHECK(fit.first_sample == 5);
  CHECK(fit.parameters[0] == 1 + 2 * 2 + 5 * 2);
  // More regressors of the same samples never leave more.
  HighOrderArxOptions narrow = of_orders({2, 5});
  narrow.criterion = OrderCriterion::bic;
  const HighOrderArx both = identify_high_order_arx(y, r, of_orders({5}));
  CHECK(both.e_d.row(0).squaredNorm() <= fit.e_d.row(0).squaredNorm());
}

TEST_CASE("high-order ARX: references that stand still, or none, change nothing but the count") {
  const Eigen::MatrixXd r = random_steps(2, 300, 317);
  const Eigen::MatrixXd y = coupled_outputs(r, 318);
  Eigen::MatrixXd still(3, 300);
  still << r, Eigen::RowVectorXd::Constant(300, 4.0);
  const HighOrderArx fit = identify_high_order_arx(y, r, of_orders({3}));
  const HighOrderArx same = identify_high_order_arx(y, still, of_orders({3}));
  CHECK(same.parameters == fit.parameters);
  CHECK((same.e_d - fit.e_d).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(identify_high_order_arx(y, Eigen::MatrixXd(0, 300), of_orders({3})).parameters[0] == 7);
}

TEST_CASE("high-order ARX: what cannot be meant is refused") {
  const Eigen::MatrixXd r = random_steps(2, 40, 319);
  const Eigen::MatrixXd y = coupled_outputs(r, 320);
  CHECK_THROWS_WITH(identify_high_order_arx(y, r, of_orders({})), Catch::Contains("found none"));
  CHECK_THROWS_WITH(identify_high_order_arx(y, r, of_orders({3, 0})), Catch::Contains("found 0"));
  CHECK_THROWS_WITH(identify_high_order_arx(y, r, of_orders({8})),
                    Catch::Contains("found 40; allowed: 42 or more"));
  const Eigen::MatrixXd more = random_steps(2, 42, 321);
  CHECK(mpm::fewest_samples(of_orders({8}), 2, 2) == 42);
  CHECK_NOTHROW(identify_high_order_arx(coupled_outputs(more, 322), more, of_orders({8})));
  CHECK_THROWS_WITH(identify_high_order_arx(y, r.leftCols(39), of_orders({1})), Catch::Contains("40 and 39"));
  HighOrderArxOptions fit = of_orders({1, 2});
  fit.criterion = OrderCriterion::validation_fit;
  CHECK_THROWS_WITH(identify_high_order_arx(y, r, fit), Catch::Contains("validation_loss, aic or bic"));
  HighOrderArxOptions no_inputs = of_orders({1});
  no_inputs.input_order = 0;
  CHECK_THROWS_WITH(identify_high_order_arx(y, r, no_inputs), Catch::Contains("order of the references"));
  Eigen::MatrixXd broken = y;
  broken(1, 7) = std::nan("");
  CHECK_THROWS_WITH(identify_high_order_arx(broken, r, of_orders({1})),
                    Catch::Contains("output 1: found no value at sample 7"));
}
