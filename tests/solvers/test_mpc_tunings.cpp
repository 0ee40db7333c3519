#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/prediction.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/plants/plant_samples.hpp"
#include "tests/solvers/small_loop.hpp"

// What industrial controllers have beside the terms of the thesis: limits of the moves, blocked moves,
// reference trajectories, resting values, linear costs of violations.

namespace mpm {
namespace {

using namespace samples;

Mpc small_controller(const MpcOptions& options, const std::string& back_end = "active-set") {
  return {small_model(), 2, options, qp_solver_factory(back_end)};
}

Eigen::MatrixXd moves_of(const Eigen::MatrixXd& u) {
  return u.rightCols(u.cols() - 1) - u.leftCols(u.cols() - 1);
}

/// A step of the disturbance that asks for large moves.
LoopInputs pushed() {
  return {
      .output_disturbance = [](int k) { return Eigen::Vector2d(k < 5 ? 0.0 : 1.5, k < 20 ? 0.0 : -0.8); }};
}

/// One CV with this channel, at a setpoint without anything else.
MpcOptions single_setpoint() {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  MpcOptions options;
  options.prediction_horizon = 8;
  options.control_horizon = 8;
  options.move_suppression = 0 * one;
  options.target_weight = 0 * one;
  options.setpoint_weight = one;
  options.slack_weight = 0 * one;
  options.mv_hard = Limits::none(1);
  options.cv_hard = Limits::none(1);
  options.cv_soft = Limits::none(1);
  options.mv_cost = 0 * one;
  return options;
}

}  // namespace

TEST_CASE("no move is larger than its limit, and the loop arrives all the same", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  MpcOptions options = small_options();
  options.move_limit = Eigen::Vector2d(0.05, kInfinity);
  Mpc limited = small_controller(options, back_end);
  Mpc unlimited = small_controller(small_options(), back_end);
  const LoopRun run = run_small_loop(limited, pushed(), 150), free = run_small_loop(unlimited, pushed(), 150);
  REQUIRE(run.ok);
  CHECK(moves_of(run.u).row(0).cwiseAbs().maxCoeff() == Approx(0.05).margin(1e-7));  // it binds
  CHECK(moves_of(run.u).row(1).cwiseAbs().maxCoeff() > 0.05);
  CHECK(moves_of(free.u).row(0).cwiseAbs().maxCoeff() > 0.2);
  CHECK((run.u.col(149) - free.u.col(149)).cwiseAbs().maxCoeff() < 1e-4);
}

TEST_CASE("with limited moves the active-set method and Ipopt plan the same", "[mpc]") {
  MpcOptions options = small_options();
  options.move_limit = Eigen::Vector2d(0.05, 0.03);
  Mpc fast = small_controller(options), ipopt = small_controller(options, "ipopt");
  const LoopRun a = run_small_loop(fast, pushed(), 60), b = run_small_loop(ipopt, pushed(), 60);
  REQUIRE(a.ok);
  REQUIRE(b.ok);
  CHECK((a.u - b.u).cwiseAbs().maxCoeff() < 1e-5);  // an interior point of 1e-10 counts as 1e-5 at a limit
  const Eigen::Index row = fast.move_problem()->structure.row_count() - 1;
  CHECK(fast.move_problem()->data.hard_upper(row) == 0.03);
}

TEST_CASE("a blocked plan has the response of its positions, each held for its block", "[prediction]") {
  const TransferMatrix model = small_model();
  const int hp = 20;
  MpcOptions options = small_options();
  options.control_horizon = 3;
  options.move_blocks = {1, 4, 2};
  REQUIRE(options.move_starts() == std::vector<int>{0, 1, 5});
  const RowMajorMatrix blocked = forced_response(model, 2, 2, hp, options.move_starts());
  const RowMajorMatrix single = forced_response(model, 2, 2, hp, {0, 1, 2, 3, 4, 5});
  const Eigen::MatrixXd plan = rough_input(2, 3);
  Eigen::MatrixXd held(2, 6);
  held << plan.col(0), plan.col(1), plan.col(1), plan.col(1), plan.col(1), plan.col(2);
  const Eigen::VectorXd of_blocks = blocked * plan.reshaped(), of_samples = single * held.reshaped();
  CHECK((of_blocks - of_samples).cwiseAbs().maxCoeff() < 1e-12);

  Mpc controller = small_controller(options);
  const LoopRun run = run_small_loop(controller, pushed(), 150);
  REQUIRE(run.ok);
  CHECK(run.y(0, 149) <= 0.5 + 1e-3);
}

TEST_CASE("blocks that do not fit the horizons are refused", "[mpc]") {
  MpcOptions options = small_options();
  for (const std::vector<int>& blocks : {std::vector<int>{1, 2}, {1, 0, 1, 1}, {1, 1, 18, 1}}) {
    options.move_blocks = blocks;
    CHECK_THROWS_AS(small_controller(options), InputError);
  }
}

// Without anything else in the objective y(k+1) can be put where the reference is: the CV follows
// y_set (1 - e^{-k Ts / tau_ref}).
TEST_CASE("a CV follows its reference trajectory to the setpoint", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  MpcOptions options = single_setpoint();
  const double tau = GENERATE(0.0, 5.0);
  options.reference_time = Eigen::VectorXd::Constant(1, tau);
  const TransferMatrix model{{TransferFunction::first_order(2, 10)}};
  Mpc controller(model, 1, options, qp_solver_factory(back_end));
  LinearPlant plant(model, options.sample_time);
  const Eigen::VectorXd none(0), y_set = Eigen::VectorXd::Constant(1, 3.0);
  controller.reset(Eigen::VectorXd::Zero(1), none);
  controller.set_setpoints(y_set);
  for (int k = 0; k < 20; ++k) {
    const double expected = tau > 0 ? 3.0 * (1.0 - std::exp(-k / tau)) : k > 0 ? 3.0 : 0.0;
    CHECK(plant.output()(0) == Approx(expected).margin(1e-6));
    plant.advance(controller.step(plant.output(), none).u);
  }
}

TEST_CASE("an MV rests at its resting value, or as near as the limits of the CVs allow", "[mpc]") {
  MpcOptions options = small_options();
  options.mv_cost.setZero();
  options.resting_value = Eigen::Vector2d(0.1, -0.05);
  options.resting_weight = Eigen::Vector2d(1, 4);
  Mpc controller = small_controller(options);
  const Eigen::VectorXd d = Eigen::VectorXd::Zero(1);
  CHECK((controller.nominal_target(d) - options.resting_value).cwiseAbs().maxCoeff() < 1e-6);

  // y1 = 2 u1 + 0.5 u2 at most -0.2: the point of that line with the least w'(u - r)^2.
  options.cv_soft.upper(0) = -0.2;
  Mpc limited = small_controller(options);
  const Eigen::Vector2d gain(2, 0.5);
  const Eigen::Vector2d step = options.resting_weight.cwiseInverse().cwiseProduct(gain);
  const Eigen::Vector2d expected =
      options.resting_value - step * (gain.dot(options.resting_value) + 0.2) / gain.dot(step);
  CHECK((limited.nominal_target(d) - expected).cwiseAbs().maxCoeff() < 1e-6);
}

// K = 1.5, Hc = 1, no dynamics: the plan is x with Hp (w_u (x - t)^2 + l (1 - b - K x)) + w_du x^2.
TEST_CASE("a linear cost of violations acts by its slope", "[mpc]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  const auto form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  INFO(back_end << ", " << to_string(form));
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  MpcOptions options = single_setpoint();
  options.control_horizon = 1;
  options.setpoint_weight = 0 * one;
  options.move_suppression = 2 * one;
  options.target_weight = 0.5 * one;
  options.slack_cost = 0.4 * one;
  options.slack_form = form;
  options.mv_hard = {-4 * one, 4 * one};
  options.cv_soft = {one, 9 * one};
  options.mv_cost = one;
  const double K = 1.5, b = -2.0, hp = options.prediction_horizon;
  Mpc controller(TransferMatrix{{TransferFunction(K * one, one)}}, 1, options, qp_solver_factory(back_end));
  controller.reset(0 * one, Eigen::VectorXd(0));
  const ControlMove& move = controller.step(b * one, Eigen::VectorXd(0));
  REQUIRE(move.status == ControlStatus::ok);
  const double t = (1 - b) / K;
  const double x = (2 * hp * 0.5 * t + hp * 0.4 * K) / (2 * hp * 0.5 + 2 * 2);
  REQUIRE(b + K * x < 1 - 1e-3);  // violated
  CHECK(move.u(0) == Approx(x).margin(1e-5));
}

}  // namespace mpm
