#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/analysis/sensitivity/unsettled.hpp"
#include "tests/solvers/active_set_factory.hpp"

// T0 and y0 of controllers with setpoints, and of controllers without targets.

namespace mpm {
namespace {

/// P2 under setpoint MPC without noise and without a limit that could become active: the loop is linear.
Study linear_study() {
  Study study = find_study("chapter4-shell");
  study.simulation.noise_standard_deviation.setZero();
  study.controller.mv_hard = Limits::none(3);
  return study;
}

/// The CV is held below 0 in place of at its setpoint; 0 is where the loop starts.
void put_in_range(Study& study, Eigen::Index cv) {
  MpcOptions& controller = study.controller;
  controller.slack_weight(cv) = controller.setpoint_weight(cv);
  controller.setpoint_weight(cv) = 0.0;
  controller.cv_soft.lower(cv) = -0.5;
  controller.cv_soft.upper(cv) = 0.0;
  study.sensitivity.active_cvs.push_back(cv);
  study.simulation.setpoint_steps.clear();
}

ExperimentDraw scenario(const Study& study, const std::string& name) {
  const auto& all = study.scenarios;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Scenario& s) { return s.name == name; });
  REQUIRE(found != all.end());
  return draw_experiment(study, found - all.begin());
}

NominalSensitivity sensitivity_of(const Study& study) {
  return nominal_sensitivity(study, operating_point(study, testing::kFactory), testing::kFactory);
}

/// S0 of one column by a route without references: the closed loop under a step of `size` added to the CV.
Eigen::MatrixXd disturbance_response(Study study, Eigen::Index cv, double size) {
  study.controller.cv_hard = Limits::none(3);
  study.controller.cv_soft.lower.setConstant(-kInfinity);
  const int N = study.simulation.samples = study.sensitivity.samples;
  LoopSignals signals{Eigen::MatrixXd::Zero(0, N), Eigen::MatrixXd::Zero(3, N), Eigen::MatrixXd::Zero(3, N)};
  signals.y_d.row(cv).setConstant(size);
  const Trajectory loop = run_closed_loop(study, study.plant.G, signals, testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  return loop.y / size;
}

/// S0 + T0 = I at each sample, whichever controller: a step of a reference is to the controller what a
/// disturbance of the other sign is.
void check_sum_is_identity(const Study& study) {
  const NominalSensitivity t0 = sensitivity_of(study);
  REQUIRE(t0.active.size() == 3);
  for (std::size_t a = 0; a < t0.active.size(); ++a) {
    const Eigen::Index j = t0.active[a].cv;
    // A setpoint goes up; an upper limit goes down, into the range.
    const double size = t0.active[a].kind == ConstraintKind::setpoint ? -0.1 : 0.1;
    const Eigen::MatrixXd s0 = disturbance_response(study, j, size);
    Eigen::MatrixXd sum = s0.rightCols(s0.cols() - 1) + t0.step_response[a].leftCols(s0.cols() - 1);
    sum.row(j).array() -= 1.0;
    INFO("column of CV " << j);
    // Both solve the same QPs up to 1e-10, over a step of 0.1.
    CHECK(sum.cwiseAbs().maxCoeff() < 1e-6);
  }
}

}  // namespace

TEST_CASE("theorem (3.9): y0 from a loop with mismatch or disturbance is the output of the basis loop") {
  Study study = linear_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const std::string name = GENERATE("Scen1", "Scen2", "Scen3", "Scen5", "Scen6");
  INFO(name);
  const Trajectory loop = simulate_experiment(study, scenario(study, name), testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  const Eigen::MatrixXd y_sim =
      simulated_output(study.plant.G, study.controller.sample_time, basis.point.u, loop.u, loop.d);
  const Eigen::MatrixXd away = loop.y - basis.trajectory.y;
  REQUIRE(away.cwiseAbs().maxCoeff() > 0.1);  // there is something to take away
  const NominalOutputs nominal = nominal_outputs(basis.sensitivity, loop.y, y_sim);
  // What is left: T0 is cut off after 200 samples, and the solver's tolerance, both times the error.
  const double error = (loop.y - y_sim).cwiseAbs().maxCoeff();
  const Eigen::MatrixXd left = nominal.y0 - basis.trajectory.y;
  CHECK(left.cwiseAbs().maxCoeff() < (10.0 * testing::unsettled(basis.sensitivity) + 1e-6) * error);
  CHECK(left.cwiseAbs().maxCoeff() < 1e-4 * away.cwiseAbs().maxCoeff());
}

TEST_CASE("y0 converges to the basis loop as T0 gets longer") {
  Study study = linear_study();
  const Trajectory loop = simulate_experiment(study, scenario(study, "Scen1"), testing::kFactory);
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const Eigen::MatrixXd y_sim =
      simulated_output(study.plant.G, study.controller.sample_time, basis.point.u, loop.u, loop.d);
  double before = kInfinity;
  for (const int samples : {20, 50, 100, 200}) {
    study.sensitivity.samples = samples;
    const Eigen::MatrixXd y0 = nominal_outputs(sensitivity_of(study), loop.y, y_sim).y0;
    const double left = (y0 - basis.trajectory.y).cwiseAbs().maxCoeff();
    INFO(samples);
    CHECK(left < 0.7 * before);
    before = left;
  }
}

TEST_CASE("a setpoint controller has a T0 with static gain I, and S0 + T0 = I by separate routes") {
  const Study study = linear_study();
  const NominalSensitivity t0 = sensitivity_of(study);
  // What the responses still change by over their last tenth, and the solver's tolerance.
  CHECK((t0.static_gain() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
        10.0 * testing::unsettled(t0) + 1e-6);
  CHECK(testing::unsettled(t0) < 1e-4);
  check_sum_is_identity(study);
}

TEST_CASE("a mixed controller without targets: setpoints are reached, the limit is kept, S0 + T0 = I") {
  Study study = linear_study();
  put_in_range(study, 2);
  const NominalSensitivity t0 = sensitivity_of(study);
  REQUIRE(t0.active.size() == 3);
  CHECK(t0.active[2] == ActiveConstraint{2, ConstraintKind::upper_limit});
  const Eigen::Matrix3d gain = t0.static_gain();
  CHECK((gain.topRows<2>() - Eigen::Matrix<double, 2, 3>::Identity()).cwiseAbs().maxCoeff() < 1e-3);
  // The CV in its range ends at or below its limit. Nothing brings it back up after an overshoot.
  CHECK(gain(2, 2) >= 1.0 - 1e-3);
  CHECK(gain.row(2).head<2>().maxCoeff() < 1e-3);
  check_sum_is_identity(study);
}

TEST_CASE("a soft-constraint controller without targets brings a CV back to its limit, S0 + T0 = I") {
  Study study = linear_study();
  for (const Eigen::Index cv : {0, 1, 2})
    put_in_range(study, cv);
  const Eigen::Matrix3d gain = sensitivity_of(study).static_gain();
  for (Eigen::Index i = 0; i < 3; ++i)
    CHECK(gain(i, i) >= 1.0 - 1e-3);  // at or below the limit that moved down
  check_sum_is_identity(study);
}

TEST_CASE("without targets T0 of a limit does not depend on the direction that is asked for") {
  Study study = linear_study();
  for (const Eigen::Index cv : {0, 1, 2})
    put_in_range(study, cv);
  study.sensitivity.step_direction = StepDirection::into_range;
  const NominalSensitivity into = sensitivity_of(study);
  study.sensitivity.step_direction = GENERATE(
      StepDirection::out_of_range, StepDirection::mean);  // nothing draws a CV to a limit that leaves
  const NominalSensitivity asked = sensitivity_of(study);
  for (std::size_t a = 0; a < into.active.size(); ++a)
    CHECK(asked.step_response[a] == into.step_response[a]);
}

TEST_CASE("variance_centre: about the setpoint or about the mean") {
  Study study = linear_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const Trajectory loop = simulate_experiment(study, scenario(study, "Scen1"), testing::kFactory);
  const NominalOutputs nominal = nominal_outputs(
      basis.sensitivity, loop.y,
      simulated_output(study.plant.G, study.controller.sample_time, basis.point.u, loop.u, loop.d));
  const Eigen::MatrixXd y_set = setpoints(study);
  const auto ivar = [&](VarianceCentre centre) {
    study.diagnosis.variance_centre = centre;
    return DiagnosisChain(study).diagnose(loop.y, nominal).ivar;
  };
  const Eigen::VectorXd about_setpoint = ivar(VarianceCentre::setpoint),
                        about_mean = ivar(VarianceCentre::mean);
  const auto centred = [](const Eigen::MatrixXd& y) { return (y.colwise() - y.rowwise().mean()).eval(); };
  for (Eigen::Index i = 0; i < 3; ++i) {  // (3.24) and (2.20) from their definitions
    CHECK(about_setpoint(i) ==
          Approx((loop.y - y_set).row(i).squaredNorm() / (nominal.y0 - y_set).row(i).squaredNorm()));
    CHECK(about_mean(i) ==
          Approx(centred(loop.y).row(i).squaredNorm() / centred(nominal.y0).row(i).squaredNorm()));
  }
}

}  // namespace mpm
