#include <catch2/catch.hpp>

#include "plants/models/catalogue.hpp"
#include "scenarios/random/random_stream.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "solvers/target_optimizer.hpp"
#include "tests/solvers/p1_controller.hpp"
#include "tests/solvers/vertex_search.hpp"

namespace mpm {
namespace {

using samples::p1_options;
using samples::VertexSearch;

// Interior-point accuracy: multiplier * distance = 1e-10 at limits whose multipliers are of order one puts a
// vertex off by 1e-10, times the condition number of three rows of K (below 1e3, unless they nearly fall
// together).
constexpr double kTargets = 1e-6;

constexpr double kPrice = 8 * 1000;  // largest MV cost of P1 times the default target_violation_cost

Eigen::MatrixXd p1_gain() {
  return benchmark_plant("shell-7x3").G.static_gain();
}

TargetOptimizer p1_targets(const std::string& back_end, const MpcOptions& options = p1_options()) {
  return {p1_gain().leftCols(3), options, qp_solver_factory(back_end)};
}

Eigen::VectorXd random_disturbance(std::uint64_t index, double size) {
  RandomStream random(7, index, StreamId::excitation);
  return Eigen::VectorXd::NullaryExpr(7, [&](Eigen::Index) { return random.uniform(-size, size); });
}

}  // namespace

TEST_CASE("at zero disturbance P1 stands at y1, y2 low and y7 high", "[target]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  TargetOptimizer targets = p1_targets(back_end);
  const QpResult& result = targets.solve(Eigen::VectorXd::Zero(7));
  REQUIRE(result.status == QpStatus::solved);
  const Eigen::VectorXd y = p1_gain().leftCols(3) * result.x;
  CHECK(y(0) == Approx(0).margin(kTargets));  // lower limits of y1 and y2
  CHECK(y(1) == Approx(0).margin(kTargets));
  CHECK(y(6) == Approx(0).margin(kTargets));    // upper limit of y7
  CHECK(result.x.cwiseAbs().maxCoeff() < 0.4);  // all MVs free of their limits of 0.5
  CHECK(result.slack.maxCoeff() < kTargets);
  // All three limits push: they, and no others, determine the targets.
  CHECK(result.soft_dual(0) < -0.1);
  CHECK(result.soft_dual(1) < -0.1);
  CHECK(result.soft_dual(6) > 0.1);
}

TEST_CASE("the targets are those of a search over all vertices", "[target]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  TargetOptimizer targets = p1_targets(back_end);
  int keepable = 0;
  int unkeepable = 0;
  for (std::uint64_t draw = 0; draw < 40; ++draw) {
    INFO(back_end << ", draw " << draw);
    const Eigen::VectorXd y_at_zero = random_disturbance(draw, draw % 2 == 0 ? 0.4 : 1.2);
    const VertexSearch search(p1_gain().leftCols(3), p1_options(), y_at_zero);
    const QpResult& result = targets.solve(y_at_zero);
    REQUIRE(result.status == QpStatus::solved);
    CHECK(result.objective == Approx(search.smallest_cost(kPrice)).epsilon(1e-6).margin(1e-6));
    // The price times an error of the violation is an error of the cost, hence a violation right to 1e-6.
    CHECK(search.violation(result.x) == Approx(search.smallest_violation()).margin(kTargets));
    CHECK(result.slack.sum() == Approx(search.smallest_violation()).margin(kTargets));
    if (const auto kept = search.keeping_all_limits()) {
      ++keepable;
      CHECK((result.x - *kept).lpNorm<Eigen::Infinity>() < kTargets);  // the penalty is exact
    } else {
      ++unkeepable;
      CHECK(result.slack.sum() > kTargets);
    }
  }
  CHECK(keepable >= 5);  // both kinds were tried
  CHECK(unkeepable >= 5);
}

TEST_CASE("without MV costs the violations are as small as they can be", "[target]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  MpcOptions options = p1_options();
  options.mv_cost.setZero();
  TargetOptimizer targets = p1_targets(back_end, options);
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    INFO("draw " << draw);
    const Eigen::VectorXd y_at_zero = random_disturbance(draw, 0.8);
    const QpResult& result = targets.solve(y_at_zero);
    REQUIRE(result.status == QpStatus::solved);
    const VertexSearch search(p1_gain().leftCols(3), options, y_at_zero);
    CHECK(search.violation(result.x) == Approx(search.smallest_violation()).margin(kTargets));
  }
}

TEST_CASE("replaced soft limits move the targets", "[target]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  TargetOptimizer targets = p1_targets(back_end);
  Limits limits = p1_options().cv_soft;
  limits.lower(0) = 0.1;
  targets.set_cv_soft(limits);
  const QpResult& result = targets.solve(Eigen::VectorXd::Zero(7));
  REQUIRE(result.status == QpStatus::solved);
  CHECK(p1_gain().leftCols(3).row(0).dot(result.x) == Approx(0.1).margin(kTargets));
}

TEST_CASE("after a reset the targets come out the same, bit for bit", "[target]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  TargetOptimizer targets = p1_targets(back_end);
  const Eigen::VectorXd first = targets.solve(random_disturbance(1, 0.4)).x;
  targets.solve(random_disturbance(2, 0.4));
  targets.reset();
  CHECK(targets.solve(random_disturbance(1, 0.4)).x == first);
}

}  // namespace mpm
