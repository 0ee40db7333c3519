#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/sensitivity/control_structure.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

// Which constraints a controller works at, and y0 by the S0 of each (assumptions A, B and C of 3.3.3).

namespace mpm {
namespace {

Study setpoint_study() {
  return find_study("chapter4-shell");
}

/// A made-up loop of the setpoint study: u1 is at its upper limit from sample 20 to 34.
struct MadeUpLoop {
  Study study = setpoint_study();
  Trajectory loop;
  OperatingPoint point;

  MadeUpLoop() {
    study.sensitivity.samples = 30;
    study.sensitivity.structure = SensitivityStructure::by_instant;
    point = operating_point(study, testing::kFactory);
    loop.y = Eigen::MatrixXd::NullaryExpr(3, 60, [](Eigen::Index i, Eigen::Index k) {
      return std::sin(0.3 * static_cast<double>(k) + static_cast<double>(i));
    });
    loop.u = 0.5 * loop.y;
    loop.u.row(0).segment(20, 15).setConstant(study.controller.mv_hard.upper(0));
    loop.u_target = Eigen::MatrixXd::Zero(3, 60);
    loop.d = Eigen::MatrixXd::Zero(0, 60);
  }

  /// T0 without u1 and with all MVs, as step responses of CV j on CV i.
  NominalSensitivity sensitivity(bool saturated) const {
    OperatingPoint at = point;
    if (saturated)
      at.fixed_mvs = {0};
    return nominal_sensitivity(study, at, testing::kFactory);
  }

  static bool saturated(Eigen::Index k) { return k >= 20 && k < 35; }
};

double impulse(const NominalSensitivity& t0, Eigen::Index i, Eigen::Index j, Eigen::Index l) {
  const Eigen::MatrixXd& step = t0.step_response[static_cast<std::size_t>(j)];
  if (l < 1 || l > step.cols())
    return 0.0;
  return step(i, l - 1) - (l > 1 ? step(i, l - 2) : 0.0);
}

const ActiveConstraint kSetpoint0{0, ConstraintKind::setpoint}, kSetpoint1{1, ConstraintKind::setpoint};

}  // namespace

TEST_CASE("setpoints are always active, and an MV is fixed while it is at a limit") {
  const MadeUpLoop made_up;
  const auto structures = control_structures(made_up.study, made_up.loop, made_up.loop.y);
  REQUIRE(structures.size() == 60);
  for (std::size_t k = 0; k < structures.size(); ++k) {
    INFO(k);
    CHECK(structures[k].active ==
          std::vector<ActiveConstraint>{kSetpoint0, kSetpoint1, {2, ConstraintKind::setpoint}});
    const bool saturated = MadeUpLoop::saturated(static_cast<Eigen::Index>(k));
    CHECK(structures[k].fixed_mvs ==
          (saturated ? std::vector<Eigen::Index>{0} : std::vector<Eigen::Index>{}));
  }
}

TEST_CASE("without targets a CV in a range is active at and beyond its limits, on the side of the limit") {
  MadeUpLoop made_up;
  Study& study = made_up.study;
  study.controller.setpoint_weight(2) = 0.0;
  study.controller.slack_weight(2) = 1.0;
  study.controller.cv_soft.lower(2) = -1.0;
  study.controller.cv_soft.upper(2) = 2.0;
  made_up.loop.y.row(2).setZero();
  made_up.loop.y.row(2).head(5) << -1.5, -1.0, 0.0, 2.0, 2.5;
  const auto structures = control_structures(study, made_up.loop, made_up.loop.y);
  const ActiveConstraint lower{2, ConstraintKind::lower_limit}, upper{2, ConstraintKind::upper_limit};
  CHECK(structures[0].active == std::vector{kSetpoint0, kSetpoint1, lower});
  CHECK(structures[1].active == std::vector{kSetpoint0, kSetpoint1, lower});
  CHECK(structures[2].active == std::vector{kSetpoint0, kSetpoint1});
  CHECK(structures[3].active == std::vector{kSetpoint0, kSetpoint1, upper});
  CHECK(structures[4].active == std::vector{kSetpoint0, kSetpoint1, upper});

  study.controller.cv_soft.lower(2) = -kInfinity;  // a range open to one side
  const auto open = control_structures(study, made_up.loop, made_up.loop.y);
  CHECK(open[0].active == std::vector{kSetpoint0, kSetpoint1});
  CHECK(open[4].active == std::vector{kSetpoint0, kSetpoint1, upper});
}

TEST_CASE("with targets the steady state that the optimizer aims at decides, not y and u") {
  const Study study = find_study("wood-berry");
  const Eigen::MatrixXd gain = study.plant.G.static_gain();
  Trajectory loop;
  loop.u = Eigen::MatrixXd::Constant(2, 4, 0.5);  // at the limit, which says nothing: its target is not
  loop.d = Eigen::MatrixXd::Zero(1, 4);
  loop.u_target = Eigen::MatrixXd::Zero(2, 4);
  // Targets for a steady state (xD, xB) in the midst of both ranges, at a limit of either, and one MV at its
  // limit.
  const Eigen::Matrix2d K = gain.leftCols(2);
  const auto target = [&](double xD, double xB) {
    return K.fullPivLu().solve(Eigen::Vector2d(xD, xB)).eval();
  };
  loop.u_target.col(0) = target(0.5, -0.5);
  loop.u_target.col(1) = target(0.0, -0.5);
  loop.u_target.col(2) = target(0.5, 0.0);
  loop.u_target.col(3) = target(0.5, -0.5);
  Eigen::MatrixXd y = Eigen::MatrixXd::Constant(2, 4, 9.0);
  loop.y = y;
  const auto at_rest = control_structures(study, loop, y);
  CHECK(at_rest[0] == ControlStructure{});
  CHECK(at_rest[1].active == std::vector<ActiveConstraint>{{0, ConstraintKind::lower_limit}});
  CHECK(at_rest[2].active == std::vector<ActiveConstraint>{{1, ConstraintKind::upper_limit}});

  // The bias y - y_sim and the measured disturbance move that steady state.
  loop.y(1, 0) += 0.5;
  loop.d(0, 3) = 0.5 / gain(1, 2);
  loop.u_target(0, 2) = 0.5;
  const auto moved = control_structures(study, loop, y);
  CHECK(moved[0].active == std::vector<ActiveConstraint>{{1, ConstraintKind::upper_limit}});
  CHECK(moved[3].active == std::vector<ActiveConstraint>{{1, ConstraintKind::upper_limit}});
  CHECK(moved[2].fixed_mvs == std::vector<Eigen::Index>{0});
}

TEST_CASE("assumption C is assumption A, bit for bit, when nothing saturates") {
  Study study = setpoint_study();
  study.controller.mv_hard = Limits::none(3);
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const NominalSensitivity t0 = nominal_sensitivity(study, point, testing::kFactory);
  const Trajectory loop = simulate_experiment(study, draw_experiment(study, 1), testing::kFactory);
  const NominalOutputs a = NominalEstimator(study, point, t0, testing::kFactory).estimate(loop);
  study.sensitivity.structure = SensitivityStructure::by_instant;
  study.sensitivity.switching = GENERATE(SensitivitySwitching::output, SensitivitySwitching::input);
  const NominalOutputs c = NominalEstimator(study, point, t0, testing::kFactory).estimate(loop);
  CHECK(c.y_sim == a.y_sim);
  if (study.sensitivity.switching == SensitivitySwitching::output) {
    CHECK(c.y0 == a.y0);
    CHECK(c.y0_diag == a.y0_diag);
  } else {  // a sum of parts: rounding, outputs of about 1
    CHECK((c.y0 - a.y0).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((c.y0_diag - a.y0_diag).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("switched output and switched input are the sums of their definitions") {
  MadeUpLoop made_up;
  const NominalSensitivity with = made_up.sensitivity(false), without = made_up.sensitivity(true);
  REQUIRE((with.step_response[0] - without.step_response[0]).cwiseAbs().maxCoeff() > 0.1);
  made_up.study.sensitivity.switching = GENERATE(SensitivitySwitching::output, SensitivitySwitching::input);
  const bool by_output = made_up.study.sensitivity.switching == SensitivitySwitching::output;
  const NominalOutputs nominal =
      NominalEstimator(made_up.study, made_up.point, with, testing::kFactory).estimate(made_up.loop);
  const Eigen::MatrixXd e = made_up.loop.y - nominal.y_sim;
  for (Eigen::Index k = 0; k < 60; ++k)
    for (Eigen::Index i = 0; i < 3; ++i) {
      double full = nominal.y_sim(i, k), diagonal = full;
      for (Eigen::Index l = 1; l <= k; ++l) {
        const bool saturated = MadeUpLoop::saturated(by_output ? k : k - l);
        for (Eigen::Index j = 0; j < 3; ++j) {
          const double part = impulse(saturated ? without : with, i, j, l) * e(j, k - l);
          full += part;
          if (i == j)
            diagonal += part;
        }
      }
      INFO("CV " << i << ", sample " << k);
      CHECK(nominal.y0(i, k) == Approx(full).margin(1e-11));  // rounding of the sums
      CHECK(nominal.y0_diag(i, k) == Approx(diagonal).margin(1e-11));
    }
}

TEST_CASE("assumption B: T0 with fixed_mvs is the setpoint response of the loop without these MVs") {
  Study study = setpoint_study();
  study.sensitivity.fixed_mvs = {0};
  const int N = study.simulation.samples = study.sensitivity.samples = 60;
  study.simulation.setpoint_steps.clear();
  const OperatingPoint point = operating_point(study, testing::kFactory);
  CHECK(point.fixed_mvs == std::vector<Eigen::Index>{0});
  const NominalSensitivity t0 = nominal_sensitivity(study, point, testing::kFactory);

  study.controller.mv_hard = Limits::none(3);
  study.controller.mv_hard.lower(0) = study.controller.mv_hard.upper(0) = 0.0;
  LoopSignals signals{Eigen::MatrixXd::Zero(0, N), Eigen::MatrixXd::Zero(3, N), Eigen::MatrixXd::Zero(3, N),
                      Eigen::MatrixXd::Zero(3, N)};
  signals.y_set.row(1).tail(N - 1).setConstant(0.1);
  const Trajectory loop = run_closed_loop(study, study.plant.G, signals, testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  CHECK(loop.u.row(0).isZero(1e-9));
  // Sample 1 sees the step first; the same QPs up to 1e-10, over a step of 0.1.
  CHECK((loop.y.rightCols(N - 2) / 0.1 - t0.step_response[1].leftCols(N - 2)).cwiseAbs().maxCoeff() < 1e-6);
}

}  // namespace mpm
