#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/solvers/small_loop.hpp"

// How the controller behaves in a closed loop, and what it refuses.

namespace mpm {
namespace {

using namespace samples;

Mpc small_controller(const std::string& back_end, const MpcOptions& options = small_options()) {
  return {small_model(), 2, options, qp_solver_factory(back_end)};
}

/// Says that it failed, whatever it is asked.
class FailingSolver final : public QpSolver {
 public:
  using QpSolver::QpSolver;

 private:
  void do_solve(const QpData&, QpResult& result) override { result.status = QpStatus::numerical_error; }
  void do_reset() override {}
};

Eigen::VectorXd md(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

}  // namespace

TEST_CASE("a loop at its targets stays there", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  Mpc controller = small_controller(back_end);
  const LoopRun run = run_small_loop(controller, {}, 20);
  REQUIRE(run.ok);
  // Both CVs are at limits that touch: an interior-point complementarity of 1e-10 counts as 1e-5 there.
  CHECK((run.y.array() + 0.5).abs().maxCoeff() < 1e-4);
  CHECK((run.u.colwise() - run.u.col(0)).cwiseAbs().maxCoeff() < 1e-4);
}

TEST_CASE("a constant output disturbance leaves no offset", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  const double size = GENERATE(0.4, -0.4);
  INFO(back_end << ", " << size);
  Mpc controller = small_controller(back_end);
  const LoopInputs inputs{.output_disturbance = [=](int k) { return Eigen::Vector2d(k < 5 ? 0 : size, 0); }};
  const LoopRun run = run_small_loop(controller, inputs, 150);
  REQUIRE(run.ok);
  CHECK(run.y(0, 5) == Approx(-0.5 + size).margin(1e-4));  // it did act
  // 145 samples of 2 min are 14 of the longest time constant of 20 min: e^-14 = 1e-6 is left, below the 1e-5
  // of an interior-point method at a limit that touches.
  CHECK((run.y.col(149).array() + 0.5).abs().maxCoeff() < 1e-4);
}

TEST_CASE("an MD acts through its measured value alone, from its sample on", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  Mpc controller = small_controller(back_end);
  const LoopRun quiet = run_small_loop(controller, {}, 12);
  const LoopInputs step{.md = [](int k) { return k < 6 ? 0.0 : 0.5; }};
  const LoopRun stepped = run_small_loop(controller, step, 12);
  CHECK(stepped.u.leftCols(6) == quiet.u.leftCols(6));       // bit for bit: nothing is known before
  CHECK(stepped.y.leftCols(7) == quiet.y.leftCols(7));       // y(6) does not show d(6) yet,
  CHECK((stepped.u.col(6) - quiet.u.col(6)).norm() > 0.01);  // and the move of sample 6 answers it
}

TEST_CASE("an MD that the model knows leaves no offset", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  Mpc controller = small_controller(back_end);
  const LoopRun run = run_small_loop(controller, {.md = [](int k) { return k < 6 ? 0.0 : 0.3; }}, 150);
  REQUIRE(run.ok);
  CHECK((run.y.col(149).array() + 0.5).abs().maxCoeff() < 1e-4);  // as for an output disturbance
}

TEST_CASE("reset makes two runs bit-identical", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  const LoopInputs inputs{
      .md = [](int k) { return 0.3 * std::sin(0.7 * k); },
      .output_disturbance =
          [](int k) { return Eigen::Vector2d(0.2 * std::cos(1.1 * k), 0.1 * std::sin(k)); }};
  Mpc controller = small_controller(back_end);
  const LoopRun first = run_small_loop(controller, inputs, 25);
  const LoopRun again = run_small_loop(controller, inputs, 25);
  Mpc other = small_controller(back_end);
  const LoopRun fresh = run_small_loop(other, inputs, 25);
  CHECK(again.u == first.u);
  CHECK(fresh.u == first.u);
}

TEST_CASE("the MVs keep their hard limits", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  MpcOptions options = small_options();
  options.mv_hard.lower = Eigen::Vector2d(-0.6, -0.7);
  options.mv_hard.upper = Eigen::Vector2d(0.4, 0.3);
  const LoopInputs inputs{
      .output_disturbance = [](int k) { return Eigen::Vector2d(k / 8 % 2 == 0 ? 3 : -3, 0); }};
  Mpc controller = small_controller(back_end, options);
  const LoopRun run = run_small_loop(controller, inputs, 48);
  REQUIRE(run.ok);
  // Bounds are kept by every back end to 1e-10 (Ipopt: exactly, as its bounds are not relaxed); the sum of
  // u(k-1) and a move rounds in the 16th digit.
  CHECK((options.mv_hard.lower - run.u.rowwise().minCoeff()).maxCoeff() < 1e-9);
  CHECK((run.u.rowwise().maxCoeff() - options.mv_hard.upper).maxCoeff() < 1e-9);
  CHECK(run.u.row(0).maxCoeff() > 0.4 - 1e-3);  // they were reached
  CHECK(run.u.row(0).minCoeff() < -0.6 + 1e-3);
}

TEST_CASE("an MV out of service stays where it is", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  MpcOptions options = small_options();
  options.mv_hard.lower(1) = options.mv_hard.upper(1) = -0.1;
  Mpc controller = small_controller(back_end, options);
  const LoopRun run = run_small_loop(controller, {.md = [](int k) { return k < 3 ? 0.0 : 0.5; }}, 15);
  REQUIRE(run.ok);
  // Kept to 1e-8: Ipopt takes fixed variables out of the problem.
  CHECK((run.u.row(1).array() + 0.1).abs().maxCoeff() < 1e-8);
  CHECK((run.u.row(0).array() - run.u(0, 0)).abs().maxCoeff() > 0.01);
}

TEST_CASE("soft limits that are replaced count from then on", "[mpc]") {
  const auto back_end = GENERATE(from_range(loop_back_ends()));
  INFO(back_end);
  Mpc controller = small_controller(back_end);
  Limits limits = small_options().cv_soft;
  limits.lower(0) = -0.2;
  controller.set_cv_soft(limits);
  const LoopRun run = run_small_loop(controller, {}, 10);
  REQUIRE(run.ok);
  CHECK((run.y.row(0).array() + 0.2).abs().maxCoeff() < 1e-4);  // as for a loop at its targets
  CHECK_THROWS_AS(controller.set_cv_soft(Limits::none(3)), InputError);
}

TEST_CASE("a hard limit that is lost inside the dead time is infeasible", "[mpc]") {
  const auto back_end = GENERATE(from_range(qp_solver_names()));
  INFO(back_end);
  MpcOptions options = small_options();
  options.cv_hard = {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)};
  Mpc controller = small_controller(back_end, options);
  const Eigen::Vector2d u(0.1, 0.2);
  controller.reset(u, md(0));
  // CV 0 answers to no MV within a sample; the output bias carries the measured 1.2 into the prediction.
  const ControlMove& move = controller.step(Eigen::Vector2d(1.2, 0), md(0));
  CHECK(move.status == ControlStatus::infeasible);
  CHECK(move.u == u);
  // The next sample is a new problem.
  CHECK(controller.step(Eigen::Vector2d(0.3, 0.2), md(0)).status == ControlStatus::ok);
}

TEST_CASE("a solver that fails is reported and the MVs stay", "[mpc]") {
  const QpSolverFactory failing = [](std::shared_ptr<const QpStructure> structure) {
    return std::make_unique<FailingSolver>(std::move(structure));
  };
  Mpc controller(small_model(), 2, small_options(), failing);
  const Eigen::Vector2d u(0.1, 0.2);
  controller.reset(u, md(0));
  const ControlMove& move = controller.step(Eigen::Vector2d(0, 0), md(0));
  CHECK(move.status == ControlStatus::failed);
  CHECK(move.u == u);
}

TEST_CASE("a controller whose problem takes Ipopt too long has failed, and names the key", "[mpc]") {
  MpcOptions options = small_options();
  options.solver_time_limit = 1e-9;
  Mpc controller = small_controller("ipopt", options);
  controller.reset(Eigen::Vector2d(0, 0), md(0));
  CHECK(controller.step(Eigen::Vector2d(0, 0), md(0)).status == ControlStatus::failed);
  CHECK(controller.failure() ==
        "the solver gave no answer: Ipopt needed more than "
        "controller.solver_time_limit, 1e-09 s, for a problem");
  // The other method has no use for it.
  Mpc other = small_controller("active-set", options);
  CHECK(run_small_loop(other, {}, 5).ok);
}

TEST_CASE("controller statuses have names", "[mpc]") {
  CHECK(to_string(ControlStatus::ok) == "ok");
  CHECK(to_string(ControlStatus::infeasible) == "infeasible");
  CHECK(to_string(ControlStatus::failed) == "failed");
}

TEST_CASE("a controller refuses a wrong size and a number that is not finite", "[mpc]") {
  const auto factory = qp_solver_factory("ipopt");
  CHECK_THROWS_AS(Mpc(small_model(), 0, small_options(), factory), InputError);
  CHECK_THROWS_AS(Mpc(small_model(), 4, small_options(), factory), InputError);
  CHECK_THROWS_AS(Mpc(small_model(), 3, small_options(), factory), InputError);  // options for two MVs

  Mpc controller = small_controller("ipopt");
  const Eigen::Vector2d two(0, 0);
  const Eigen::Vector3d three(0, 0, 0);
  const double nan = kNaN;
  CHECK_THROWS_AS(controller.reset(three, md(0)), InputError);
  CHECK_THROWS_AS(controller.reset(two, two), InputError);
  CHECK_THROWS_AS(controller.reset(two, md(nan)), InputError);
  CHECK_THROWS_AS(controller.step(three, md(0)), InputError);
  CHECK_THROWS_AS(controller.step(two, two), InputError);
  CHECK_THROWS_AS(controller.step(Eigen::Vector2d(0, nan), md(0)), InputError);
  CHECK_THROWS_AS(controller.step(two, md(nan)), InputError);
  CHECK_THROWS_AS(controller.nominal_target(two), InputError);
  CHECK_THROWS_AS(controller.nominal_target(md(nan)), InputError);
}

}  // namespace mpm
