#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "solvers/mpc.hpp"
#include "solvers/qp_solver_factory.hpp"

// The controller of a CV that integrates.

namespace mpm {
namespace {

constexpr double kRate = 0.5, kSample = 2.0;

/// A tank: what flows in and out, and a pressure that the first flow moves, too.
TransferMatrix tank() {
  const auto flow = [](double rate) {
    return TransferFunction(Eigen::VectorXd::Constant(1, rate), Eigen::Vector2d(1, 0));
  };
  return {{flow(kRate), flow(-kRate), flow(kRate)},
          {TransferFunction::first_order(2, 5), TransferFunction::zero(), TransferFunction::zero()}};
}

MpcOptions tank_options() {
  MpcOptions options;
  options.sample_time = kSample;
  options.prediction_horizon = 10;
  options.control_horizon = 3;
  options.move_suppression = Eigen::Vector2d(1, 1);
  options.target_weight = Eigen::Vector2d(1, 1);
  options.setpoint_weight = Eigen::Vector2d(0, 0);
  options.slack_weight = Eigen::Vector2d(10, 10);
  options.mv_hard = {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)};
  options.cv_hard = Limits::none(2);
  options.cv_soft = {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)};
  options.mv_cost = Eigen::Vector2d(-1, 0);
  return options;
}

/// One level, one flow, one step ahead: the law of the controller can be written down.
MpcOptions one_step_options(double weight, double suppression) {
  MpcOptions options;
  options.sample_time = kSample;
  options.prediction_horizon = options.control_horizon = 1;
  options.move_suppression = Eigen::VectorXd::Constant(1, suppression);
  options.target_weight = Eigen::VectorXd::Zero(1);
  options.setpoint_weight = Eigen::VectorXd::Constant(1, weight);
  options.slack_weight = Eigen::VectorXd::Zero(1);
  options.mv_hard = Limits::none(1);
  options.cv_hard = Limits::none(1);
  options.cv_soft = Limits::none(1);
  options.mv_cost = Eigen::VectorXd::Zero(1);
  return options;
}

TransferMatrix level() {
  return {{TransferFunction(Eigen::VectorXd::Constant(1, kRate), Eigen::Vector2d(1, 0))}};
}

/// The level of the loop after `samples` under a constant flow that is not known.
double offset_under_unknown_flow(const MpcOptions& options, double flow, int samples) {
  Mpc controller(level(), 1, options, qp_solver_factory("auto"));
  LinearPlant plant(level(), kSample);
  const Eigen::VectorXd none(0);
  controller.reset(Eigen::VectorXd::Zero(1), none);
  for (int k = 0; k < samples; ++k)
    plant.advance(controller.step(plant.output(), none).u + Eigen::VectorXd::Constant(1, flow));
  return plant.output()(0);
}

}  // namespace

TEST_CASE("the targets of an integrating CV hold its rate at 0, not its value", "[mpc]") {
  Mpc controller(tank(), 2, tank_options(), qp_solver_factory("auto"));
  const Eigen::VectorXd d = Eigen::VectorXd::Constant(1, 0.3);
  const Eigen::VectorXd target = controller.nominal_target(d);
  // The pressure at its upper limit, and the outflow balances both inflows.
  CHECK(target(0) == Approx(0.5).margin(1e-7));
  CHECK(target(1) == Approx(0.5 + 0.3).margin(1e-7));
  // A level above its limit changes nothing of the targets; a flow that is not known does, and where no
  // target balances it, as much of it as can be is balanced.
  const Eigen::VectorXd more = controller.nominal_target(Eigen::VectorXd::Constant(1, 0.8));
  CHECK(more(1) == Approx(1.0).margin(1e-7));
  CHECK(more(0) == Approx(0.2).margin(1e-7));
}

TEST_CASE("one step ahead the loop of a level is that of its difference equation", "[mpc]") {
  constexpr double q = 4, r = 3, g = kRate * kSample;
  Mpc controller(level(), 1, one_step_options(q, r), qp_solver_factory("auto"));
  const Eigen::VectorXd none(0);
  controller.reset(Eigen::VectorXd::Zero(1), none);
  controller.set_setpoints(Eigen::VectorXd::Ones(1));
  LinearPlant plant(level(), kSample);
  double y = 0, u = 0;
  for (int k = 0; k < 60; ++k) {
    CHECK(plant.output()(0) == Approx(y).margin(1e-9));
    plant.advance(controller.step(plant.output(), none).u);
    u += q * g * (1 - y - g * u) / (q * g * g + r);  // min q (1 - y(k+1))^2 + r du^2
    y += g * u;
  }
  CHECK(y == Approx(1.0).margin(1e-3));
}

TEST_CASE("a flow that is not known leaves an offset, unless the bias has a ramp", "[mpc]") {
  constexpr double q = 4, r = 3, g = kRate * kSample, flow = 0.2;
  MpcOptions options = one_step_options(q, r);
  // At rest u = -flow, and du = 0 asks for -y - g u = 0.
  CHECK(offset_under_unknown_flow(options, flow, 400) == Approx(g * flow).margin(1e-8));
  for (const double share : {0.05, 0.5, 1.0}) {
    options.bias_ramp = Eigen::VectorXd::Constant(1, share);
    CHECK(std::abs(offset_under_unknown_flow(options, flow, 400)) < 1e-7);
  }
  options.bias_ramp(0) = 1.5;
  CHECK_THROWS_AS(Mpc(level(), 1, options, qp_solver_factory("auto")), InputError);
}

TEST_CASE("a constant error of a level is no ramp", "[mpc]") {
  MpcOptions options = one_step_options(4, 3);
  options.bias_ramp = Eigen::VectorXd::Constant(1, 0.5);
  Mpc controller(level(), 1, options, qp_solver_factory("auto"));
  const Eigen::VectorXd none(0), y = Eigen::VectorXd::Constant(1, 0.7);
  controller.reset(Eigen::VectorXd::Zero(1), none);
  controller.set_setpoints(y);  // where it is from the first sample on
  CHECK(std::abs(controller.step(y, none).u(0)) < 1e-9);
  CHECK(std::abs(controller.step(y, none).u(0)) < 1e-9);
}

TEST_CASE("a flow that is measured late is no ramp of the bias once it is told", "[mpc][late_measurements]") {
  constexpr double share = 0.5, flow = 0.2, g = kRate * kSample;
  MpcOptions options = tank_options();
  options.bias_ramp = Eigen::Vector2d(share, 0);
  options.md_analysers = {{1, 4}};
  Mpc controller(tank(), 2, options, qp_solver_factory("auto"));
  LinearPlant plant(tank(), kSample);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(3);
  input.head(2) = controller.nominal_target(input.tail(1));
  controller.reset(input.head(2), input.tail(1));
  plant.reset(input);
  input(2) = flow;
  double ramp = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double told = k < 4 ? 0.0 : flow;
    const ControlMove& move = controller.step(plant.output(), Eigen::VectorXd::Constant(1, told));
    if (k > 0)  // of the bias, which rises by g flow until the flow is told, and then is none
      ramp += share * ((k < 4 ? g * flow : 0.0) - ramp);
    CHECK(move.u_target(1) == Approx(0.5 + told + ramp / g).margin(1e-7));
    input.head(2) = move.u;
    plant.advance(input);
  }
}

}  // namespace mpm
