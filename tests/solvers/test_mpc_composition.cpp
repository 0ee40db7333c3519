#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/prediction.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/solvers/small_loop.hpp"

// One controller, composed of terms: setpoints, ranges, both at once, with and without targets.

namespace mpm {
namespace {

using namespace samples;

/// (2.26): both CVs at setpoints, no targets, no soft limits.
MpcOptions setpoint_options() {
  MpcOptions options = small_options();
  options.setpoint_weight = Eigen::Vector2d(4, 2);
  options.target_weight.setZero();
  options.slack_weight.setZero();
  options.cv_soft = Limits::none(2);
  return options;
}

/// The first CV at a setpoint, the second one in its range; targets for both MVs.
MpcOptions mixed_options() {
  MpcOptions options = small_options();
  options.setpoint_weight = Eigen::Vector2d(4, 0);
  options.slack_weight(0) = 0;
  options.cv_soft.lower(0) = -kInfinity;
  options.cv_soft.upper(0) = kInfinity;
  return options;
}

Mpc controller_of(const std::string& back_end, const MpcOptions& options) {
  return {small_model(), 2, options, qp_solver_factory(back_end)};
}

/// Objective of (2.26) for planned MV positions v, relative to rest, from its definition: a simulation.
double simulated_objective(const MpcOptions& options, const Eigen::VectorXd& v,
                           const Eigen::Vector2d& y_set) {
  LinearPlant plant(small_model(), options.sample_time);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(3);
  plant.reset(input);
  double objective = 0.0;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (int i = 0; i < options.prediction_horizon; ++i) {
    const int planned = std::min(i, options.control_horizon - 1);
    const Eigen::Vector2d now = v.segment(2 * planned, 2);
    objective += options.move_suppression.dot((now - before).cwiseAbs2());
    before = now;
    input.head(2) = now;
    plant.advance(input);
    objective += options.setpoint_weight.dot((plant.output() - y_set).cwiseAbs2());
  }
  return objective;
}

}  // namespace

TEST_CASE("setpoint MPC: its first plan minimises (2.26), evaluated by simulation", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  const MpcOptions options = setpoint_options();
  Mpc controller = controller_of(back_end, options);
  const Eigen::Vector2d y_set(0.3, -0.2);
  controller.set_setpoints(y_set);
  controller.reset(Eigen::Vector2d::Zero(), Eigen::VectorXd::Zero(1));
  REQUIRE(controller.step(Eigen::Vector2d::Zero(), Eigen::VectorXd::Zero(1)).status == ControlStatus::ok);
  const Eigen::VectorXd plan = controller.move_problem()->result.x;
  const double best = simulated_objective(options, plan, y_set);
  // A quadratic with its minimum at the plan is even about it: the first-order part must vanish.
  const double h = 1e-4;
  for (Eigen::Index i = 0; i < plan.size(); ++i) {
    Eigen::VectorXd up = plan, down = plan;
    up(i) += h;
    down(i) -= h;
    const double above = simulated_objective(options, up, y_set);
    const double below = simulated_objective(options, down, y_set);
    CHECK(above > best);
    CHECK(below > best);
    CHECK(std::abs(above - below) / (2 * h) < 1e-6);
  }
}

TEST_CASE("setpoint MPC reaches its setpoints, whatever acts on the outputs", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  Mpc controller = controller_of(back_end, setpoint_options());
  const Eigen::Vector2d y_set(0.4, -0.3);
  controller.set_setpoints(y_set);
  const LoopInputs inputs{.md = [](int k) { return k < 40 ? 0.0 : 0.3; },
                          .output_disturbance = [](int) { return Eigen::Vector2d(0.2, -0.1); }};
  const LoopRun run = run_small_loop(controller, inputs, 150);
  REQUIRE(run.ok);
  // The slowest pole of the loop has decayed below 1e-6 after 100 samples.
  CHECK((run.y.rightCols<1>() - y_set).cwiseAbs().maxCoeff() < 1e-5);
  CHECK(run.u.col(0).cwiseAbs().maxCoeff() < 2.0);
  CHECK(!controller.target_problem().has_value());
}

TEST_CASE("mixed control: one CV at its setpoint, the other at the edge of its range that is cheapest",
          "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  Mpc controller = controller_of(back_end, mixed_options());
  controller.set_setpoints(Eigen::Vector2d(0.25, 0));
  const LoopRun run = run_small_loop(controller, {.md = [](int k) { return k < 5 ? 0.0 : 0.2; }}, 200);
  REQUIRE(run.ok);
  CHECK(run.y(0, 199) == Approx(0.25).margin(1e-4));
  CHECK(run.y(1, 199) == Approx(-0.5).margin(1e-4));  // both costs are positive and so are the gains to y2
}

TEST_CASE("soft limits without targets: nothing moves inside the ranges, and what leaves is brought back",
          "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  MpcOptions options = small_options();
  options.target_weight.setZero();
  Mpc controller = controller_of(back_end, options);
  const LoopInputs pushed{.output_disturbance = [](int k) { return Eigen::Vector2d(k < 30 ? 0.4 : 0.9, 0); }};
  const LoopRun run = run_small_loop(controller, pushed, 250);
  REQUIRE(run.ok);
  CHECK(run.u.leftCols(30).cwiseAbs().maxCoeff() < 1e-6);  // 1e-8 of an interior point, twice
  CHECK(run.y(0, 30) > 0.5);
  // Where in its range it stops is open: nothing draws it to an edge.
  CHECK(run.y.col(249).cwiseAbs().maxCoeff() < 0.5 + 1e-3);
  CHECK((run.u.col(249) - run.u.col(239)).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("a range of no width and a heavy slack weight are a setpoint", "[mpc]") {
  MpcOptions range = setpoint_options();
  range.setpoint_weight.setZero();
  range.slack_weight = Eigen::Vector2d(4, 2);
  range.cv_soft = {Eigen::Vector2d(0.4, -0.3), Eigen::Vector2d(0.4, -0.3)};
  Mpc by_range = controller_of("active-set", range);
  Mpc by_setpoint = controller_of("active-set", setpoint_options());
  by_setpoint.set_setpoints(Eigen::Vector2d(0.4, -0.3));
  const LoopRun a = run_small_loop(by_range, {}, 60);
  const LoopRun b = run_small_loop(by_setpoint, {}, 60);
  REQUIRE(a.ok);
  REQUIRE(b.ok);
  CHECK((a.u - b.u).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("weights that do not determine the moves are refused", "[mpc]") {
  MpcOptions options = small_options();
  options.move_suppression(0) = options.target_weight(0) = 0;
  CHECK_THROWS_WITH(controller_of("active-set", options), Catch::Contains("move_suppression[0]"));

  // One setpoint cannot decide two MVs.
  options = setpoint_options();
  options.move_suppression.setZero();
  CHECK_NOTHROW(controller_of("active-set", options));
  options.setpoint_weight(1) = 0;
  CHECK_THROWS_WITH(controller_of("active-set", options), Catch::Contains("determine every move"));

  options = small_options();
  options.slack_weight(1) = 0;
  CHECK_THROWS_WITH(controller_of("active-set", options), Catch::Contains("slack_weight[1]"));
  options = setpoint_options();
  options.setpoint_weight(1) = -1;
  CHECK_THROWS_WITH(controller_of("active-set", options), Catch::Contains("setpoint_weight[1]"));
  Mpc controller = controller_of("active-set", setpoint_options());
  CHECK_THROWS_WITH(controller.set_setpoints(Eigen::Vector3d::Zero()), Catch::Contains("setpoints"));
}

}  // namespace mpm
