#include <algorithm>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "solvers/qp_solver_factory.hpp"
#include "tests/solvers/small_loop.hpp"

// Moves against closed forms that are put together here from the definition of the cost.

namespace mpm {
namespace {

using samples::small_model;
using samples::small_options;

// An interior-point method stops at a complementarity of 1e-10: with limits a hundredth or more away, and a
// Hessian with eigenvalues above 1, the move is off by at most 1e-8.
constexpr double kMove = 1e-7;

/// The least-squares form of the cost over the plan x: |W_du (D x)|^2 + |W_u (T x - t)|^2, written out sample
/// by sample over the whole prediction horizon.
struct PlanCost {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

PlanCost plan_cost(const MpcOptions& options, const Eigen::VectorXd& t) {
  const Eigen::Index nu = t.size();
  const Eigen::Index hp = options.prediction_horizon;
  const Eigen::Index hc = options.control_horizon;
  Eigen::MatrixXd position = Eigen::MatrixXd::Zero(hp * nu, hc * nu);  // u(k+i) - u(k-1) of the plan
  for (Eigen::Index i = 0; i < hp; ++i)
    position.block(i * nu, std::min(i, hc - 1) * nu, nu, nu).setIdentity();
  Eigen::MatrixXd move = position;  // u(k+i) - u(k+i-1)
  move.bottomRows((hp - 1) * nu) -= position.topRows((hp - 1) * nu);
  const Eigen::VectorXd move_weight = options.move_suppression.replicate(hp, 1);
  const Eigen::VectorXd target_weight = options.target_weight.replicate(hp, 1);
  return {2 * (move.transpose() * move_weight.asDiagonal() * move +
               position.transpose() * target_weight.asDiagonal() * position),
          -2 * position.transpose() * target_weight.asDiagonal() * t.replicate(hp, 1)};
}

/// Column e: the response of CV `cv` over the horizon to a plan that is 1 in element e.
Eigen::MatrixXd plan_response(const MpcOptions& options, Eigen::Index cv) {
  const Eigen::Index nu = 2;
  const Eigen::Index hp = options.prediction_horizon;
  const Eigen::Index hc = options.control_horizon;
  Eigen::MatrixXd response(hp, hc * nu);
  for (Eigen::Index e = 0; e < hc * nu; ++e) {
    Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(3, hp + 1);
    const Eigen::Index i = e / nu;
    inputs.row(e % nu).segment(i, i == hc - 1 ? hp + 1 - i : 1).setOnes();
    response.col(e) = simulate(small_model(), options.sample_time, inputs).row(cv).tail(hp).transpose();
  }
  return response;
}

/// A controller that has made three moves from a steady state, and a copy of its model beside it.
struct Situation {
  Mpc controller;
  LinearPlant model;
  Eigen::VectorXd u, d;

  Situation(const MpcOptions& options, const std::string& back_end)
      : controller(small_model(), 2, options, qp_solver_factory(back_end)),
        model(small_model(), options.sample_time),
        u(Eigen::Vector2d(0.3, -0.2)),
        d(Eigen::VectorXd::Constant(1, 0.1)) {
    model.reset(input());
    controller.reset(u, d);
    for (int k = 0; k < 3; ++k)
      step(Eigen::Vector2d(0.02, -0.01));
  }

  Eigen::VectorXd input() const {
    Eigen::VectorXd all(3);
    all << u, d;
    return all;
  }

  /// One step with outputs `bias` away from the model's.
  ControlMove step(const Eigen::Vector2d& bias) {
    const ControlMove move = controller.step(model.output() + bias, d);
    REQUIRE(move.status == ControlStatus::ok);
    u = move.u;
    model.advance(input());
    return move;
  }

  /// CV `cv` over the horizon with the MVs held.
  Eigen::VectorXd free_response(Eigen::Index cv, double bias, Eigen::Index horizon) const {
    LinearPlant ahead = model;
    Eigen::VectorXd response(horizon);
    for (Eigen::Index l = 0; l < horizon; ++l) {
      ahead.advance(input());
      response(l) = ahead.output()(cv) + bias;
    }
    return response;
  }
};

MpcOptions without_limits() {
  MpcOptions options = small_options();
  options.cv_soft = {Eigen::Vector2d(-1e3, -1e3), Eigen::Vector2d(1e3, 1e3)};
  options.mv_hard.upper.setConstant(5);
  options.mv_hard.lower.setConstant(-5);
  options.move_suppression *= 10;  // so that no planned move comes near the limits
  return options;
}

}  // namespace

TEST_CASE("far from all limits the move is the linear gain", "[mpc]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  const MpcOptions options = without_limits();
  Situation loop(options, back_end);
  const Eigen::VectorXd before = loop.u;
  const ControlMove move = loop.step(Eigen::Vector2d(0.1, 0.2));
  CHECK((move.u_target - options.mv_hard.lower).norm() < kMove);  // costs are positive, nothing else counts
  const PlanCost cost = plan_cost(options, move.u_target - before);
  const Eigen::VectorXd plan = -cost.hessian.llt().solve(cost.gradient);
  CHECK((move.u - before - plan.head(2)).norm() < kMove);
  CHECK(plan.head(2).norm() > 0.01);  // and there was something to compare
}

TEST_CASE("with one soft limit violated all along the move is the ridge solution", "[mpc]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  MpcOptions options = without_limits();
  options.cv_soft.lower(0) = -0.5;
  options.slack_weight(0) = 0.05;  // weak, so that the limit stays violated over the horizon
  Situation loop(options, back_end);
  const Eigen::VectorXd before = loop.u;
  const Eigen::Vector2d bias(-6, 0.1);
  const Eigen::VectorXd free = loop.free_response(0, bias(0), options.prediction_horizon);
  const ControlMove move = loop.step(bias);

  const PlanCost cost = plan_cost(options, move.u_target - before);
  const Eigen::MatrixXd R = plan_response(options, 0);
  const double tau = options.slack_weight(0);
  const Eigen::VectorXd gap = (-0.5 - free.array()).matrix();
  const Eigen::VectorXd plan = (cost.hessian + 2 * tau * R.transpose() * R)
                                   .llt()
                                   .solve(-cost.gradient + 2 * tau * R.transpose() * gap);
  REQUIRE((gap - R * plan).minCoeff() > 0.01);  // violated all along, as the closed form supposes
  CHECK((move.u - before - plan.head(2)).norm() < kMove);
  const Eigen::VectorXd unlimited = -cost.hessian.llt().solve(cost.gradient);
  CHECK((plan - unlimited).head(2).norm() > 0.01);  // the limit does matter
}

// One MV that acts on one CV by a gain K alone, Hc = 1: y(k+l) = K u + b for all l, and
//     w_du x^2 + Hp w_u (x - t)^2 + Hp tau (lower - y)^2
// is the cost for either slack form: the weight of a slack per CV counts once a sample.
TEST_CASE("the weight of a slack per CV counts once a sample", "[mpc]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  const auto form = GENERATE(SlackForm::per_sample, SlackForm::per_cv);
  INFO(back_end << ", " << to_string(form));
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  MpcOptions options;
  options.prediction_horizon = 7;
  options.move_suppression = 2 * one;
  options.target_weight = 0.5 * one;
  options.setpoint_weight = 0 * one;
  options.slack_weight = 3 * one;
  options.slack_form = form;
  options.mv_hard = {-4 * one, 4 * one};
  options.cv_hard = Limits::none(1);
  options.cv_soft = {one, 9 * one};
  options.mv_cost = one;
  const double K = 1.5;
  const TransferMatrix model{{TransferFunction(K * one, one)}};
  Mpc controller(model, 1, options, qp_solver_factory(back_end));
  controller.reset(0 * one, Eigen::VectorXd(0));

  const double b = -2;  // y measured, with the model at 0
  const ControlMove& move = controller.step(b * one, Eigen::VectorXd(0));
  REQUIRE(move.status == ControlStatus::ok);
  const double t = (1 - b) / K;  // the cheapest target keeps the limit
  CHECK(move.u_target(0) == Approx(t).margin(kMove));
  const double hp = options.prediction_horizon;
  const double x = (hp * 0.5 * t + hp * 3 * K * (1 - b)) / (2 + hp * 0.5 + hp * 3 * K * K);
  REQUIRE(b + K * x < 1 - 1e-3);  // violated
  CHECK(move.u(0) == Approx(x).margin(kMove));
}

TEST_CASE("a squared weight Q is the direct weight Q^2", "[mpc]") {
  const auto back_end = GENERATE(from_range(samples::loop_back_ends()));
  INFO(back_end);
  MpcOptions squared = small_options();
  squared.weight_convention = WeightConvention::squared;
  MpcOptions direct = small_options();
  direct.move_suppression = direct.move_suppression.cwiseAbs2();
  direct.target_weight = direct.target_weight.cwiseAbs2();
  Situation one(squared, back_end);
  Situation other(direct, back_end);
  Situation unsquared(small_options(), back_end);
  const Eigen::Vector2d bias(-0.3, 0.2);
  const Eigen::VectorXd u = one.step(bias).u;
  CHECK(u == other.step(bias).u);  // the same problem, bit for bit
  CHECK((u - unsquared.step(bias).u).norm() > 1e-3);
}

}  // namespace mpm
