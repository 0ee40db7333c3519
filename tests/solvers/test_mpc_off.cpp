#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/solvers/small_loop.hpp"

// MVs and CVs that operators take from the controller for a while.

namespace mpm {
namespace {

using namespace samples;

constexpr int kOffSamples = 60, kOffFrom = 12, kOffUntil = 40;

/// small_model(), or with the first CV as a level.
TransferMatrix off_model(bool integrating) {
  TransferMatrix model = small_model();
  for (Eigen::Index input = 0; integrating && input < model.cols(); ++input) {
    Eigen::VectorXd numerator(1), denominator(2);
    numerator << 0.03 * (input == 1 ? 1.0 : -2.0);
    denominator << 1.0, 0.0;
    model(0, input) = TransferFunction(numerator, denominator, model(0, input).dead_time());
  }
  return model;
}

/// The tunings under which variables are switched off.
std::vector<std::pair<const char*, MpcOptions>> off_tunings() {
  MpcOptions setpoint = small_options();
  setpoint.setpoint_weight = Eigen::Vector2d(4, 0);
  setpoint.cv_soft.lower(0) = -kInfinity;
  setpoint.cv_soft.upper(0) = kInfinity;
  setpoint.reference_time = Eigen::Vector2d(5, 0);
  MpcOptions industrial = small_options();
  industrial.move_limit = Eigen::Vector2d(0.3, 0.2);
  industrial.move_blocks = {1, 2, 4, 8};
  industrial.slack_form = SlackForm::per_cv;
  industrial.slack_cost = Eigen::Vector2d(3, 0);
  industrial.cv_hard = {Eigen::Vector2d(-8, -8), Eigen::Vector2d(8, 8)};
  MpcOptions resting = small_options();
  resting.mv_cost.setZero();
  resting.resting_value = Eigen::Vector2d(0.1, -0.1);
  resting.resting_weight = Eigen::Vector2d(1, 2);
  return {{"ranges", small_options()},
          {"a setpoint", setpoint},
          {"move limits, blocks, a slack per CV", industrial},
          {"resting values", resting}};
}

Eigen::Vector2d off_disturbance(int k) {
  return {k < 15 ? 0.1 * std::sin(0.7 * k) : 0.9, k < 25 ? 0.0 : -0.7 + 0.2 * std::cos(1.3 * k)};
}

Eigen::VectorXd off_md(int k) {
  return Eigen::VectorXd::Constant(1, k < 20 ? 0.0 : 0.4);
}

Eigen::VectorXd off_setpoint() {
  return Eigen::Vector2d(0.2, 0.0);
}

/// Where the operator holds the second MV.
double operators_level(int k) {
  return k < 20 ? 0.25 : k < 30 ? -0.1 : 0.15;
}

/// What a loop of `controller` on the plant does; told(k, controller) is called before each step, and
/// asked(y, d) is its answer.
template <class Told, class Asked>
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> off_loop(const TransferMatrix& model,
                                                     const Eigen::Vector2d& start, Told told, Asked asked) {
  LinearPlant plant(model, small_options().sample_time);
  Eigen::VectorXd input(3);
  input << start, 0.0;
  plant.reset(input);
  Eigen::MatrixXd u(2, kOffSamples), u_target(2, kOffSamples);
  for (int k = 0; k < kOffSamples; ++k) {
    told(k);
    const Eigen::VectorXd y = plant.output() + off_disturbance(k);
    const std::pair<Eigen::Vector2d, Eigen::Vector2d> move = asked(k, y);
    u.col(k) = move.first;
    u_target.col(k) = move.second;
    input << u.col(k), off_md(k);
    plant.advance(input);
  }
  return {u, u_target};
}

std::pair<Eigen::Vector2d, Eigen::Vector2d> ok_move(const ControlMove& move) {
  REQUIRE(move.status == ControlStatus::ok);
  return {move.u, move.u_target};
}

SwitchedOff mv_held(Eigen::Index mv, double position) {
  SwitchedOff off = SwitchedOff::none(2, 2);
  off.position(mv) = position;
  return off;
}

SwitchedOff cv_off(Eigen::Index cv) {
  SwitchedOff off = SwitchedOff::none(2, 2);
  off.cvs(cv) = true;
  return off;
}

Limits one_of(const Limits& limits, Eigen::Index i) {
  return {limits.lower.segment(i, 1), limits.upper.segment(i, 1)};
}

Eigen::VectorXd one_of(const Eigen::VectorXd& values, Eigen::Index i) {
  return values.size() == 0 ? values : Eigen::VectorXd(values.segment(i, 1));
}

/// The tuning with the first MV alone.
MpcOptions first_mv_alone(MpcOptions options) {
  for (Eigen::VectorXd MpcOptions::*const of_mv :
       {&MpcOptions::move_suppression, &MpcOptions::target_weight, &MpcOptions::mv_cost,
        &MpcOptions::move_limit, &MpcOptions::resting_value, &MpcOptions::resting_weight})
    options.*of_mv = one_of(options.*of_mv, 0);
  options.mv_hard = one_of(options.mv_hard, 0);
  return options;
}

/// The tuning with one CV alone.
MpcOptions one_cv_alone(MpcOptions options, Eigen::Index cv) {
  for (Eigen::VectorXd MpcOptions::*const of_cv :
       {&MpcOptions::setpoint_weight, &MpcOptions::slack_weight, &MpcOptions::slack_cost,
        &MpcOptions::reference_time, &MpcOptions::bias_ramp})
    options.*of_cv = one_of(options.*of_cv, cv);
  options.cv_hard = one_of(options.cv_hard, cv);
  options.cv_soft = one_of(options.cv_soft, cv);
  return options;
}

/// Both plan with a certified residual of 1e-9; an interior point of 1e-10 counts as 1e-5 at a limit.
double off_tolerance(const std::string& back_end) {
  return back_end == "ipopt" ? 1e-4 : 1e-7;
}

}  // namespace

TEST_CASE("an MV that is off is a measured disturbance", "[mpc][off]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  const auto tuning = GENERATE(from_range(off_tunings()));
  const bool integrating = GENERATE(false, true);
  INFO(back_end << ", " << tuning.first << ", integrating " << integrating);
  const TransferMatrix model = off_model(integrating);
  MpcOptions options = tuning.second;
  if (integrating)
    options.bias_ramp = Eigen::Vector2d(0.05, 0);
  const Eigen::Vector2d start(0.5 * operators_level(0), operators_level(0));  // a level rests there

  Mpc with_two(model, 2, options, qp_solver_factory(back_end));
  with_two.set_setpoints(off_setpoint());
  with_two.reset(start, off_md(0));
  const auto [u, u_target] = off_loop(
      model, start,
      [&](int k) {
        if (k == 0 || operators_level(k) != operators_level(k - 1))
          with_two.set_off(mv_held(1, operators_level(k)));
      },
      [&](int k, const Eigen::VectorXd& y) { return ok_move(with_two.step(y, off_md(k))); });

  Mpc with_one(model, 1, first_mv_alone(options), qp_solver_factory(back_end));
  with_one.set_setpoints(off_setpoint());
  const auto measured = [&](int k) { return Eigen::Vector2d(operators_level(k), off_md(k)(0)); };
  with_one.reset(start.head(1), measured(0));
  const auto [v, v_target] = off_loop(
      model, start, [](int) {},
      [&](int k, const Eigen::VectorXd& y) {
        const ControlMove& move = with_one.step(y, measured(k));
        REQUIRE(move.status == ControlStatus::ok);
        return std::pair<Eigen::Vector2d, Eigen::Vector2d>{{move.u(0), operators_level(k)},
                                                           {move.u_target(0), operators_level(k)}};
      });
  CHECK((u.row(0) - v.row(0)).cwiseAbs().maxCoeff() < off_tolerance(back_end));
  CHECK((u_target.row(0) - v_target.row(0)).cwiseAbs().maxCoeff() < off_tolerance(back_end));
  CHECK(u.row(1) == v.row(1));
  CHECK(u_target.row(1) == v_target.row(1));
  CHECK(u.row(0).maxCoeff() - u.row(0).minCoeff() > 0.05);
}

TEST_CASE("without a CV that is off the controller is that of the other CVs", "[mpc][off]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  const auto tuning = GENERATE(from_range(off_tunings()));
  const bool integrating = GENERATE(false, true);
  INFO(back_end << ", " << tuning.first << ", integrating " << integrating);
  const TransferMatrix model = off_model(integrating);
  const Eigen::Vector2d start(0.05, 0.1);
  TransferMatrix second(1, model.cols());
  for (Eigen::Index input = 0; input < model.cols(); ++input)
    second(0, input) = model(1, input);

  Mpc with_two(model, 2, tuning.second, qp_solver_factory(back_end));
  with_two.set_setpoints(off_setpoint());
  with_two.reset(start, off_md(0));
  with_two.set_off(cv_off(0));
  const auto [u, u_target] = off_loop(
      model, start, [](int) {},
      [&](int k, const Eigen::VectorXd& y) { return ok_move(with_two.step(y, off_md(k))); });

  Mpc with_one(second, 2, one_cv_alone(tuning.second, 1), qp_solver_factory(back_end));
  with_one.reset(start, off_md(0));
  const auto [v, v_target] = off_loop(
      model, start, [](int) {},
      [&](int k, const Eigen::VectorXd& y) { return ok_move(with_one.step(y.tail(1), off_md(k))); });
  CHECK((u - v).cwiseAbs().maxCoeff() < off_tolerance(back_end));
  CHECK((u_target - v_target).cwiseAbs().maxCoeff() < off_tolerance(back_end));
  CHECK(u.row(0).maxCoeff() - u.row(0).minCoeff() > 0.05);
}

// min w (u - t)^2 + q (u - u(k-1))^2 with the target t at the cheap end of the MV and a range of the CV that
// is never left: u(k) = (w t + q u(k-1)) / (w + q).
TEST_CASE("an MV that comes back moves on from where the operator left it", "[mpc][off]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1), none(0);
  const double w = 1.0, q = 3.0, t = -2.0;
  MpcOptions options;
  options.prediction_horizon = options.control_horizon = 1;
  options.move_suppression = q * one;
  options.target_weight = w * one;
  options.setpoint_weight = 0 * one;
  options.slack_weight = one;
  options.mv_hard = {t * one, 2 * one};
  options.cv_hard = Limits::none(1);
  options.cv_soft = {-100 * one, 100 * one};
  options.mv_cost = one;
  Mpc controller({{TransferFunction::first_order(2, 10)}}, 1, options, qp_solver_factory(back_end));
  controller.reset(0 * one, none);
  double u = 0.0;
  for (int k = 0; k < 20; ++k) {
    SwitchedOff off = SwitchedOff::none(1, 1);
    if (k >= 5 && k < 10)
      off.position(0) = 2.9 - 0.1 * k;  // beyond the upper limit in the first of these samples
    controller.set_off(off);
    u = off.has_mv(0) ? off.position(0) : (w * t + q * u) / (w + q);
    CHECK(controller.step(0 * one, none).u(0) == Approx(u).margin(1e-6));  // Ipopt's accuracy near a limit
  }
}

TEST_CASE("with spells of both kinds the active-set method and Ipopt move the same", "[mpc][off]") {
  const auto tuning = GENERATE(from_range(off_tunings()));
  INFO(tuning.first);
  Eigen::MatrixXd by_back_end[2];
  int place = 0;
  for (const char* const back_end : {"active-set", "ipopt"}) {
    Mpc controller(small_model(), 2, tuning.second, qp_solver_factory(back_end));
    controller.set_setpoints(off_setpoint());
    const Eigen::Vector2d start(0.05, 0.1);
    controller.reset(start, off_md(0));
    SwitchedOff both = mv_held(1, 0.6);
    both.cvs(0) = true;
    const auto [u, u_target] = off_loop(
        small_model(), start,
        [&](int k) {
          if (k == kOffFrom)
            controller.set_off(both);
          if (k == kOffUntil)
            controller.set_off(SwitchedOff::none(2, 2));
        },
        [&](int k, const Eigen::VectorXd& y) { return ok_move(controller.step(y, off_md(k))); });
    CHECK((u.row(1).segment(kOffFrom, kOffUntil - kOffFrom).array() == 0.6).all());
    CHECK(std::abs(u(1, kOffFrom - 1) - 0.6) > 0.1);
    CHECK(std::abs(u(1, kOffSamples - 1) - 0.6) > 0.05);
    by_back_end[place++] = u;
  }
  CHECK((by_back_end[0] - by_back_end[1]).cwiseAbs().maxCoeff() < 1e-4);  // as off_tolerance()
}

TEST_CASE("what is on and off again leaves a loop at its targets as it is", "[mpc][off]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  Mpc controller(small_model(), 2, small_options(), qp_solver_factory(back_end));
  const LoopRun still = run_small_loop(controller, {}, 30);
  controller.reset(still.u.col(0), Eigen::VectorXd::Zero(1));
  for (int k = 0; k < 30; ++k) {
    if (k == 10)
      controller.set_off(mv_held(1, still.u(1, 9)));
    if (k == 20)
      controller.set_off(SwitchedOff::none(2, 2));
    CHECK(
        (controller.step(still.y.col(k), Eigen::VectorXd::Zero(1)).u - still.u.col(k)).cwiseAbs().maxCoeff() <
        off_tolerance(back_end));
  }
}

TEST_CASE("what is off before a reset is off after it", "[mpc][off]") {
  Mpc before(small_model(), 2, small_options(), qp_solver_factory("active-set"));
  Mpc after(small_model(), 2, small_options(), qp_solver_factory("active-set"));
  const Eigen::Vector2d u(0.05, 0.1), y(0.3, -0.7);
  before.set_off(mv_held(1, 0.25));
  before.reset(u, off_md(0));
  after.reset(u, off_md(0));
  after.set_off(mv_held(1, 0.25));
  CHECK(before.step(y, off_md(0)).u == after.step(y, off_md(0)).u);
  CHECK(after.step(y, off_md(0)).u(1) == 0.25);
}

TEST_CASE("a CV with a setpoint that is off has the same program again, without memory", "[mpc][off]") {
  MpcOptions options = off_tunings()[1].second;
  Mpc controller(small_model(), 2, options, qp_solver_factory("active-set"));
  controller.reset(Eigen::Vector2d(0.05, 0.1), off_md(0));
  const QpStructure* all = &controller.move_problem()->structure;
  controller.set_off(cv_off(0));
  const QpStructure* without = &controller.move_problem()->structure;
  CHECK(all != without);
  CHECK(all->rows == without->rows);
  controller.set_off(SwitchedOff::none(2, 2));
  CHECK(&controller.move_problem()->structure == all);
  controller.set_off(cv_off(1));  // it has a range only
  CHECK(&controller.move_problem()->structure == all);
  controller.set_off(cv_off(0));
  CHECK(&controller.move_problem()->structure == without);
}

TEST_CASE("wrong sizes and undetermined moves of what is off are refused", "[mpc][off]") {
  MpcOptions options = off_tunings()[1].second;
  Mpc controller(small_model(), 2, options, qp_solver_factory("active-set"));
  CHECK_THROWS_WITH(controller.set_off(SwitchedOff::none(3, 2)),
                    "variables that are off: found 2 MVs and 3 CVs; allowed: 2 and 2");
  CHECK_THROWS_WITH(controller.set_off(mv_held(0, kInfinity)),
                    "position of an MV that is off: found an infinite number; allowed: a finite one");
  options.setpoint_weight = Eigen::Vector2d(4, 2);
  options.move_suppression.setZero();
  options.target_weight.setZero();
  Mpc hard_working(small_model(), 2, options, qp_solver_factory("active-set"));
  CHECK_THROWS_WITH(hard_working.set_off(cv_off(0)), Catch::Contains("determine every move"));
}

}  // namespace mpm
