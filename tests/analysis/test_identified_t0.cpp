// T0 of the chapter 6 controller, once directly and once as appendix A3 says: identified in a record.

#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/identified_sensitivity.hpp"
#include "analysis/nominal_sensitivity.hpp"
#include "plants/linear_plant.hpp"
#include "scenarios/study_library.hpp"
#include "solvers/mpc.hpp"
#include "tests/analysis/identification_samples.hpp"

namespace {

/// A limit that moves out of the range by steps of up to 0.05, every 12 samples or more. One direction only:
/// the controller answers a limit that moves into the range differently (docs/methods.md, T0).
Eigen::RowVectorXd staircase(bool upper, Eigen::Index samples) {
  const Eigen::MatrixXd levels = mpm::testing::random_steps(1, samples / 4, 70);
  Eigen::RowVectorXd moves = Eigen::RowVectorXd::Zero(samples);
  for (Eigen::Index k = 1; k < samples; ++k) {
    const bool step = k % 4 == 0 && levels(k / 4) != levels(k / 4 - 1);
    moves(k) = moves(k - 1) + (step ? (upper ? 0.05 : -0.05) * std::abs(levels(k / 4)) : 0.0);
  }
  return moves;
}

bool is_upper(const mpm::ActiveReference& active) {
  return active.kind == mpm::ReferenceKind::upper_limit;
}

/// Outputs of the relaxed controller on its own model while one limit moves, ny x N, deviations from rest.
Eigen::MatrixXd record(const mpm::Study& study, const mpm::OperatingPoint& point,
                       const mpm::ActiveReference& moving, const Eigen::RowVectorXd& moves) {
  mpm::MpcOptions options = study.controller;
  options.mv_hard = mpm::Limits::none(study.mv_count());
  options.cv_hard = options.cv_soft = mpm::Limits::none(study.cv_count());
  for (const mpm::ActiveReference& active : point.active)
    (is_upper(active) ? options.cv_soft.upper : options.cv_soft.lower)(active.cv) =
        (is_upper(active) ? study.controller.cv_soft.upper : study.controller.cv_soft.lower)(active.cv);
  mpm::Mpc controller(study.plant.G, study.mv_count(), options, mpm::qp_solver_factory("active-set"));
  const Eigen::VectorXd d = Eigen::VectorXd::Zero(study.md_count());
  const Eigen::VectorXd u = controller.nominal_target(d);
  Eigen::VectorXd input(u.size() + d.size());
  input << u, d;
  mpm::LinearPlant plant(study.plant.G, study.controller.sample_time);
  plant.reset(input);
  controller.reset(u, d);
  const Eigen::VectorXd rest = plant.output();
  Eigen::MatrixXd y(study.cv_count(), moves.size());
  for (Eigen::Index k = 0; k < moves.size(); ++k) {
    y.col(k) = plant.output() - rest;
    mpm::Limits moved = options.cv_soft;
    (is_upper(moving) ? moved.upper : moved.lower)(moving.cv) += moves(k);
    controller.set_cv_soft(moved);
    input.head(u.size()) = controller.step(plant.output(), d).u;
    plant.advance(input);
  }
  return y;
}

}  // namespace

TEST_CASE("T0 of the chapter 6 controller, identified in a record, is the one of its step responses") {
  const mpm::Study study = mpm::find_study("chapter6");
  const mpm::QpSolverFactory factory = mpm::qp_solver_factory("active-set");
  const mpm::OperatingPoint point = operating_point(study, factory);
  REQUIRE_FALSE(point.active.empty());
  const Eigen::MatrixXd direct = nominal_sensitivity(study, point, factory).step_response[0];

  const Eigen::RowVectorXd moves = staircase(is_upper(point.active[0]), 600);
  mpm::IdentifiedSensitivityOptions options;
  options.samples = direct.cols();
  options.orders = {{0}, {8}, {4, 6}, {1}, {1}, {1}};
  const mpm::IdentifiedSensitivity T0 =
      identified_sensitivity(moves, record(study, point, point.active[0], moves), options);
  REQUIRE(T0.step_response[0].cols() == direct.cols());
  // The loop has more states than the models: 1 % of the largest response (1.5) is as near as they come.
  CHECK((T0.step_response[0] - direct).cwiseAbs().maxCoeff() < 0.015);
}
