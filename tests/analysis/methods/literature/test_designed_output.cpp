#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/identification/identification.hpp"
#include "analysis/methods/literature/designed_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::ClosedLoopModel;
using mpm::ClosedLoopModelStatus;
using mpm::designed_output;
using mpm::DesignedOrderCriterion;
using mpm::DesignedOutput;
using mpm::DesignedOutputOptions;
using mpm::testing::random_steps;
using mpm::testing::white_noise;

namespace {

/// First-order channels y_i = sum_j b_ij q^-1/(1 - a_i q^-1) u_j.
struct FirstOrderPlant {
  Eigen::VectorXd a;
  Eigen::MatrixXd b;

  Eigen::MatrixXd gain() const { return (1.0 - a.array()).inverse().matrix().asDiagonal() * b; }
};

/// The IMC loop of figure 3.1 with u = K (1 - c q^-1)/(1 - f q^-1) eps.
struct ImcLoop {
  FirstOrderPlant G, G0;
  Eigen::MatrixXd K;
  double c, f;

  struct Record {
    Eigen::MatrixXd y, y_hat, y_set;
  };

  /// Sample by sample, from rest.
  Record run(const Eigen::MatrixXd& y_set, const Eigen::MatrixXd& v_s) const {
    const Eigen::Index ny = y_set.rows();
    Record r{Eigen::MatrixXd::Zero(ny, y_set.cols()), Eigen::MatrixXd::Zero(ny, y_set.cols()), y_set};
    Eigen::VectorXd x = Eigen::VectorXd::Zero(ny), x0 = x, u = Eigen::VectorXd::Zero(K.rows()), before = x;
    for (Eigen::Index k = 0; k < y_set.cols(); ++k) {
      r.y.col(k) = x + v_s.col(k);
      r.y_hat.col(k) = x0;
      const Eigen::VectorXd eps = y_set.col(k) - r.y.col(k) + r.y_hat.col(k);
      u = f * u + K * (eps - c * before);
      before = eps;
      x = G.a.cwiseProduct(x) + G.b * u;
      x0 = G0.a.cwiseProduct(x0) + G0.b * u;
    }
    return r;
  }
  Record run(const Eigen::MatrixXd& y_set) const {
    return run(y_set, Eigen::MatrixXd::Zero(y_set.rows(), y_set.cols()));
  }
  /// The same controller with a plant that is its model.
  ImcLoop designed() const { return {G0, G0, K, c, f}; }
};

/// One CV; the zero of K cancels the pole of G0, so that G0 K = (1 - f) q^-1/(1 - f q^-1).
ImcLoop siso_loop() {
  const FirstOrderPlant G0{Eigen::VectorXd::Constant(1, 0.8), Eigen::MatrixXd::Constant(1, 1, 0.4)};
  const FirstOrderPlant G{Eigen::VectorXd::Constant(1, 0.9), Eigen::MatrixXd::Constant(1, 1, 0.3)};
  const double f = 0.6;
  return {G, G0, Eigen::MatrixXd::Constant(1, 1, (1.0 - f) / 0.4), 0.8, f};
}

/// Two CVs with interaction that K does not undo; the plant differs from its model in the first.
ImcLoop two_by_two_loop() {
  FirstOrderPlant G0{Eigen::Vector2d(0.8, 0.7), Eigen::Matrix2d::Identity()};
  G0.b << 0.4, 0.1, -0.2, 0.5;
  FirstOrderPlant G = G0;
  G.a(0) = 0.85;
  G.b(0, 1) = -0.1;
  const double c = 0.5, f = 0.6;
  return {G, G0, (1.0 - f) / (1.0 - c) * G0.gain().diagonal().cwiseInverse().asDiagonal(), c, f};
}

DesignedOutputOptions orders(std::vector<Eigen::Index> values) {
  DesignedOutputOptions options;
  options.orders = std::move(values);
  options.max_iterations = 100;  // to the minimum
  return options;
}

DesignedOutput of(const ImcLoop::Record& r, const DesignedOutputOptions& options) {
  return designed_output(r.y, r.y_hat, r.y_set, options);
}

/// Setpoints that begin where the loop does, at 0.
Eigen::MatrixXd setpoint_steps(Eigen::Index rows, Eigen::Index samples, std::uint64_t number) {
  Eigen::MatrixXd y_set = random_steps(rows, samples, number);
  y_set.col(0).setZero();
  return y_set;
}

double largest(const Eigen::MatrixXd& x) {
  return x.cwiseAbs().maxCoeff();
}

/// Output of a row of models, from its difference equations alone.
Eigen::VectorXd by_hand(const mpm::PolynomialModel& model, const Eigen::MatrixXd& u) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(u.cols());
  for (std::size_t j = 0; j < model.inputs.size(); ++j) {
    const mpm::InputPath& path = model.inputs[j];
    Eigen::VectorXd w = Eigen::VectorXd::Zero(u.cols());
    for (Eigen::Index k = 0; k < u.cols(); ++k) {
      for (Eigen::Index i = 0; i < path.B.size(); ++i)
        if (k - path.delay - i >= 0)
          w(k) += path.B(i) * u(static_cast<Eigen::Index>(j), k - path.delay - i);
      for (Eigen::Index i = 1; i < path.F.size() && i <= k; ++i)
        w(k) -= path.F(i) * w(k - i);
    }
    sum += w;
  }
  return sum;
}

}  // namespace

TEST_CASE("a known loop with one CV: the designed output is that of the loop without mismatch") {
  const ImcLoop loop = siso_loop();
  const ImcLoop::Record r = loop.run(setpoint_steps(1, 400, 70));
  const Eigen::MatrixXd y_designed = loop.designed().run(r.y_set).y;
  REQUIRE(largest(r.y - y_designed) > 0.1);
  const DesignedOutput result = of(r, orders({1, 2, 3}));
  REQUIRE(result.has(0));

  // The data obey the models exactly; what is left is where the search stops.
  CHECK(largest(result.y0 - y_designed) < 1e-6);
  CHECK(result.sensitivity[0].fit == Approx(100.0).margin(1e-4));
  CHECK(result.mismatch[0].fit == Approx(100.0).margin(1e-4));
  // S_d = (1 - q^-1)/(1 - f q^-1) answers a unit step with f^k.
  const Eigen::VectorXd step = simulate(result.sensitivity[0].model, Eigen::MatrixXd::Ones(1, 30));
  for (Eigen::Index k = 0; k < step.size(); ++k)
    CHECK(step(k) == Approx(std::pow(loop.f, k)).margin(1e-6));

  const Eigen::VectorXd y = r.y.row(0), y0 = result.y0.row(0), y_set = r.y_set.row(0);
  const double ivar = (y - y_set).squaredNorm() / (y_designed.row(0).transpose() - y_set).squaredNorm();
  CHECK(mpm::variance_index(y, y0, y_set) == Approx(ivar).epsilon(1e-6));
}

TEST_CASE("a known loop with two CVs: a mismatch in one reaches the designed output of both") {
  const ImcLoop loop = two_by_two_loop();
  const ImcLoop::Record r = loop.run(setpoint_steps(2, 600, 71));
  const Eigen::MatrixXd y_designed = loop.designed().run(r.y_set).y;
  const DesignedOutput result = of(r, orders({2, 3}));
  CHECK(result.mismatch[0].status == ClosedLoopModelStatus::identified);
  CHECK(result.mismatch[1].status == ClosedLoopModelStatus::zero);
  for (Eigen::Index i = 0; i < 2; ++i) {
    REQUIRE(result.has(i));
    REQUIRE(largest(r.y.row(i) - y_designed.row(i)) > 0.02);
    CHECK(largest(result.y0.row(i) - y_designed.row(i)) < 1e-6);
  }
}

TEST_CASE("without mismatch Delta G K is 0 and the designed output is the output") {
  const ImcLoop::Record r = two_by_two_loop().designed().run(setpoint_steps(2, 400, 72));
  const DesignedOutput result = of(r, orders({2, 3}));
  for (Eigen::Index i = 0; i < 2; ++i) {
    const ClosedLoopModel& row = result.mismatch[static_cast<std::size_t>(i)];
    CHECK(row.status == ClosedLoopModelStatus::zero);
    CHECK(std::isnan(row.fit));
    CHECK(largest(simulate(row.model, r.y_set)) == 0.0);
    CHECK(largest(result.y0.row(i) - r.y.row(i)) < 1e-6);
  }
  CHECK(largest(result.eps - r.y_set) < 1e-12);
}

TEST_CASE("a disturbance is in the designed output as far as Delta G K leaves it in y_set - v_s") {
  // y0 = y_set - S_d (y_set - v_s) (3.4). Without mismatch all of y - y_hat is v_s; what of it Delta G K
  // takes for a mismatch, and nothing else, is missing.
  const ImcLoop loop = siso_loop().designed();
  const Eigen::MatrixXd v_s = 0.1 * white_noise(600, 73).transpose();
  const ImcLoop::Record r = loop.run(setpoint_steps(1, 600, 74), v_s);
  const DesignedOutput result = of(r, orders({3}));
  const Eigen::VectorXd explained = by_hand(result.mismatch[0].model, result.eps);
  CHECK(result.mismatch[0].fit < 20.0);  // there is nothing to find
  Eigen::VectorXd expected =
      r.y.row(0).transpose() - by_hand(result.sensitivity[0].model, explained.transpose());
  CHECK(largest(result.y0.row(0).transpose() - expected) < 1e-6);
}

TEST_CASE("the designed output is what (3.7) makes of the models, by their difference equations") {
  const ImcLoop loop = two_by_two_loop();
  Eigen::MatrixXd v_s(2, 500);
  v_s << 0.05 * white_noise(500, 75).transpose(), 0.05 * white_noise(500, 76).transpose();
  const ImcLoop::Record r = loop.run(setpoint_steps(2, 500, 77), v_s);
  const DesignedOutput result = of(r, {});
  Eigen::MatrixXd reference = result.eps.colwise() - r.y_set.col(0);
  const Eigen::MatrixXd deviations = reference;
  for (Eigen::Index i = 0; i < 2; ++i)
    reference.row(i) += by_hand(result.mismatch[static_cast<std::size_t>(i)].model, deviations).transpose();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const ClosedLoopModel& S_d = result.sensitivity[static_cast<std::size_t>(i)];
    CHECK(S_d.model.inputs[0].delay == 0);
    CHECK(result.mismatch[static_cast<std::size_t>(i)].model.inputs[0].delay == 1);
    CHECK(largest(result.y0.row(i) - r.y_set.row(i) + by_hand(S_d.model, reference).transpose()) < 1e-9);
    const Eigen::VectorXd error = (r.y_set - r.y).row(i);
    CHECK(S_d.fit == Approx(mpm::percent_fit(error, by_hand(S_d.model, deviations))));
  }
}

TEST_CASE("the order chosen is the best of those tried, each tried alone") {
  const ImcLoop loop = two_by_two_loop();
  Eigen::MatrixXd v_s(2, 500);
  v_s << 0.05 * white_noise(500, 78).transpose(), 0.05 * white_noise(500, 79).transpose();
  const ImcLoop::Record r = loop.run(setpoint_steps(2, 500, 80), v_s);
  DesignedOutputOptions options;
  const DesignedOutput chosen = of(r, options);
  std::vector<double> fits;
  for (const Eigen::Index order : DesignedOutputOptions{}.orders) {
    options.orders = {order};
    const DesignedOutput alone = of(r, options);
    fits.push_back(alone.mismatch[0].fit);
    if (order == chosen.mismatch[0].order)
      CHECK(alone.mismatch[0].fit == chosen.mismatch[0].fit);
  }
  CHECK(chosen.mismatch[0].fit == *std::max_element(fits.begin(), fits.end()));

  // BIC pays for coefficients; the fit on the record does not.
  options = {};
  options.criterion = DesignedOrderCriterion::bic;
  CHECK(of(r, options).mismatch[0].order <= chosen.mismatch[0].order);
  options.criterion = DesignedOrderCriterion::validation_fit;
  const DesignedOutput validated = of(r, options);
  options.criterion = DesignedOrderCriterion::record_fit;
  options.orders = {validated.mismatch[0].order};
  CHECK(of(r, options).mismatch[0].fit == validated.mismatch[0].fit);
}

TEST_CASE("units and operating point of a CV do not matter") {
  const ImcLoop loop = two_by_two_loop();
  const ImcLoop::Record r = loop.run(setpoint_steps(2, 400, 81));
  const DesignedOutput before = of(r, orders({2, 3}));
  ImcLoop::Record other = r;
  for (Eigen::MatrixXd* x : {&other.y, &other.y_hat, &other.y_set})
    x->row(1) = (8.0 * x->row(1)).array() + 3.0;
  const DesignedOutput after = of(other, orders({2, 3}));
  CHECK(largest(after.y0.row(0) - before.y0.row(0)) < 1e-6);
  CHECK(largest(((after.y0.row(1).array() - 3.0) / 8.0).matrix() - before.y0.row(1)) < 1e-6);
}

TEST_CASE("an eps that stands still is no input, and an output that stands still has no model") {
  // The second CV is never touched: its setpoint stands still and no MV acts on it.
  ImcLoop loop = two_by_two_loop();
  loop.G0.b.row(1).setZero();
  loop.G = loop.G0;
  loop.G.a(0) = 0.85;
  loop.K = Eigen::Matrix2d::Zero();
  loop.K(0, 0) = 0.4;
  Eigen::MatrixXd y_set = setpoint_steps(2, 400, 82);
  y_set.row(1).setZero();
  const DesignedOutput result = of(loop.run(y_set), orders({2, 3}));
  CHECK(result.sensitivity[1].status == ClosedLoopModelStatus::zero);
  REQUIRE(result.sensitivity[0].status == ClosedLoopModelStatus::identified);
  CHECK(result.sensitivity[0].model.inputs.size() == 2);
  CHECK(result.sensitivity[0].model.inputs[1].B == Eigen::VectorXd::Zero(1));
  CHECK(largest(result.y0.row(0) - loop.designed().run(y_set).y.row(0)) < 1e-6);
  CHECK(largest(result.y0.row(1)) == 0.0);
}

TEST_CASE("a CV that moves while no eps does has no designed output") {
  Eigen::MatrixXd y = white_noise(200, 83).transpose();
  const DesignedOutput result = designed_output(y, y, Eigen::MatrixXd::Zero(1, 200));
  CHECK(result.sensitivity[0].status == ClosedLoopModelStatus::no_model);
  CHECK_FALSE(result.has(0));
  CHECK(result.y0.array().isNaN().all());
}

TEST_CASE("a designed output refuses what cannot be meant") {
  const Eigen::MatrixXd y = setpoint_steps(2, 60, 84);
  CHECK_THROWS_WITH(designed_output(y, y, y.leftCols(59)), Catch::Contains("2 x 60, 2 x 60 and 2 x 59"));
  CHECK_THROWS_WITH(designed_output(y.topRows(0), y.topRows(0), y.topRows(0)),
                    Catch::Contains("each with a setpoint"));
  Eigen::MatrixXd broken = y;
  broken(1, 3) = std::nan("");
  CHECK_THROWS_WITH(designed_output(y, broken, y), Catch::Contains("not finite"));
  // Order 7 from two eps has 30 coefficients.
  CHECK_THROWS_WITH(designed_output(y.leftCols(20), 0.5 * y.leftCols(20), y.leftCols(20)),
                    Catch::Contains("found 20 samples"));
  const auto refused = [&y](auto change) {
    DesignedOutputOptions options;
    change(options);
    std::string text;
    try {
      designed_output(y, y, y, options);
    } catch (const mpm::InputError& error) {
      text = error.what();
    }
    return text;
  };
  CHECK_THAT(refused([](auto& o) { o.orders.clear(); }),
             Catch::Contains("orders of a designed output: found none"));
  CHECK_THAT(refused([](auto& o) { o.orders = {3, 0}; }), Catch::Contains("found 0"));
  CHECK_THAT(refused([](auto& o) { o.validation_share = 1.0; }), Catch::Contains("validation share"));
  CHECK_THAT(refused([](auto& o) { o.max_iterations = 0; }), Catch::Contains("iterations of a search"));
  CHECK_THAT(refused([](auto& o) { o.resolution = -1.0; }), Catch::Contains("resolution"));
}
