#include <cmath>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "tests/analysis/sensitivity/unsettled.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace {

using namespace mpm;

TEST_CASE("operating point of P1: y1, y2 at the lower limit, y7 at the upper one, all MVs free") {
  Study study = find_study("chapter6");
  study.sensitivity.active_cvs.clear();  // found, not told
  const OperatingPoint point = operating_point(study, testing::kFactory);
  REQUIRE(point.active.size() == 3);
  CHECK(point.active[0] == ActiveConstraint{0, ConstraintKind::lower_limit});
  CHECK(point.active[1] == ActiveConstraint{1, ConstraintKind::lower_limit});
  CHECK(point.active[2] == ActiveConstraint{6, ConstraintKind::upper_limit});
  CHECK(point.fixed_mvs.empty());
}

TEST_CASE("T0 of P1 has the static gains that section 6.3 demands, in both directions of the step") {
  Study study = find_study("chapter6");
  for (const StepDirection direction :
       {StepDirection::into_range, StepDirection::out_of_range, StepDirection::mean}) {
    study.sensitivity.step_direction = direction;
    const OperatingPoint point = operating_point(study, testing::kFactory);
    const NominalSensitivity t0 = nominal_sensitivity(study, point, testing::kFactory);
    CHECK(testing::unsettled(t0) < 0.01);
    const Eigen::MatrixXd gain = t0.static_gain();
    // The limits act through a finite soft weight, and the responses have settled to about 1e-3.
    for (const Eigen::Index j : {0, 1, 6}) {
      for (const Eigen::Index i : {0, 1, 6})
        CHECK(std::abs(gain(i, j) - (i == j ? 1.0 : 0.0)) < 2e-3);
      for (const Eigen::Index i : {2, 3, 4, 5})
        CHECK(std::abs(gain(i, j)) > 0.015);
    }
    for (const Eigen::Index j : {2, 3, 4, 5})
      CHECK(gain.col(j).isZero(0.0));
  }
}

TEST_CASE("the static gain of T0 is that of the nominal model under square control of the active CVs") {
  const Study study = find_study("chapter6");
  const NominalSensitivity t0 =
      nominal_sensitivity(study, operating_point(study, testing::kFactory), testing::kFactory);
  const Eigen::MatrixXd K = study.plant.G.static_gain().leftCols(3);
  Eigen::Matrix3d active;
  active << K.row(0), K.row(1), K.row(6);
  // u = K_active^-1 y_active at steady state, hence T0(0) = K K_active^-1 in the active columns.
  const Eigen::MatrixXd expected = K * active.inverse();
  const Eigen::MatrixXd gain = t0.static_gain();
  CHECK((gain.col(0) - expected.col(0)).cwiseAbs().maxCoeff() < 2e-3);
  CHECK((gain.col(1) - expected.col(1)).cwiseAbs().maxCoeff() < 2e-3);
  CHECK((gain.col(6) - expected.col(2)).cwiseAbs().maxCoeff() < 2e-3);
}

TEST_CASE("S0 + T0 = I by separate routes: S0 from a step disturbance on the output") {
  // A limit that moves into the range is to the controller what a disturbance out of the range is.
  const auto [direction, disturbance] = GENERATE(
      table<StepDirection, double>({{StepDirection::into_range, -0.1}, {StepDirection::out_of_range, 0.1}}));
  Study study = find_study("chapter6");
  study.sensitivity.step_direction = direction;
  study.simulation.samples = 60;
  study.simulation.steps.clear();
  study.simulation.noise_standard_deviation.setZero();
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const NominalSensitivity t0 = nominal_sensitivity(study, point, testing::kFactory);
  // The same relaxations as for T0, in a closed loop with a step on y2 from sample 0 on.
  for (const Eigen::Index cv : {2, 3, 4, 5}) {
    study.controller.cv_soft.lower(cv) = -INFINITY;
    study.controller.cv_soft.upper(cv) = INFINITY;
  }
  study.controller.cv_soft.upper(0) = study.controller.cv_soft.upper(1) = INFINITY;
  study.controller.cv_soft.lower(6) = -INFINITY;
  study.controller.cv_hard = Limits::none(7);
  study.controller.mv_hard = Limits::none(3);
  LoopSignals signals{Eigen::MatrixXd::Zero(2, 60), Eigen::MatrixXd::Zero(7, 60),
                      Eigen::MatrixXd::Zero(7, 60)};
  signals.y_d.row(1).setConstant(disturbance);
  const Trajectory loop = run_closed_loop(study, study.plant.G, signals, testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  const Eigen::MatrixXd s0 = loop.y / disturbance;  // response of the outputs per unit disturbance on y2
  for (Eigen::Index l = 1; l < 60; ++l)
    for (Eigen::Index i = 0; i < 7; ++i)
      // The two controllers solve the same QPs up to their tolerance, 1e-10, over a step of 0.1.
      CHECK(s0(i, l) + t0.step_response[1](i, l - 1) == Approx(i == 1 ? 1.0 : 0.0).margin(1e-6));
}

TEST_CASE("nominal outputs: no error gives y0 = y, and one error passes through T0 as convolution says") {
  const Study study = find_study("chapter6");
  const NominalSensitivity t0 =
      nominal_sensitivity(study, operating_point(study, testing::kFactory), testing::kFactory);
  const Eigen::MatrixXd y = Eigen::MatrixXd::Random(7, 200);
  const NominalOutputs same = nominal_outputs(t0, y, y);
  CHECK(same.y0 == y);
  CHECK(same.y0_diag == y);

  const Eigen::MatrixXd y_sim = Eigen::MatrixXd::Random(7, 200);
  const NominalOutputs nominal = nominal_outputs(t0, y, y_sim);
  const Eigen::MatrixXd e = y_sim - y;
  const Eigen::Index k = 180;
  for (Eigen::Index i = 0; i < 7; ++i) {
    double full = y(i, k) + e(i, k), diagonal = full;  // y + S0 e = y + e - T0 e
    for (std::size_t a = 0; a < t0.active.size(); ++a) {
      const Eigen::Index j = t0.active[a].cv;
      double through = 0.0;
      for (Eigen::Index l = 1; l <= 150; ++l)
        through +=
            (t0.step_response[a](i, l - 1) - (l > 1 ? t0.step_response[a](i, l - 2) : 0.0)) * e(j, k - l);
      full -= through;
      if (i == j)
        diagonal -= through;
    }
    CHECK(nominal.y0(i, k) == Approx(full).margin(1e-11));
    CHECK(nominal.y0_diag(i, k) == Approx(diagonal).margin(1e-11));
  }
  CHECK(nominal.y0_diag.row(3) == y_sim.row(3));  // (6.17)
  CHECK_THROWS_AS(nominal_outputs(t0, y, y_sim.leftCols(10)), InputError);
}

TEST_CASE("without noise and mismatch the basis case has y0 = y and every index 1") {
  Study study = find_study("chapter6");
  study.simulation.noise_standard_deviation.setZero();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  CHECK(basis.healthy);
  CHECK((basis.nominal.y0 - basis.trajectory.y).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((basis.diagnosis.ivar.array() - 1.0).abs().maxCoeff() < 1e-9);
}

TEST_CASE("a basis case without excitation fails its self-check and says which CV") {
  Study study = find_study("chapter6");
  for (SignalStep& step : study.simulation.steps)
    step.level *= 0.02;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  CHECK_FALSE(basis.healthy);
  CHECK(basis.explanation.find("noise outweighs the excitation") != std::string::npos);
}

}  // namespace
