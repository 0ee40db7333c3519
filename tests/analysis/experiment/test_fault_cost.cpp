#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/experiment/fault_cost.hpp"
#include "analysis/indicators/loop_cost.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/world.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// ogunnaike-ray at its setpoints of 0 without limits that bind: a linear loop, which only noise moves.
Study quiet_study() {
  Study study = find_study("suite-ogunnaike-ray");
  study.simulation.setpoint_steps.clear();
  study.simulation.steps.clear();
  study.simulation.random_steps = false;
  study.simulation.md_noise_standard_deviation = {};
  study.simulation.initial_setpoint.setZero();
  study.simulation.samples = 200;
  study.world = WorldRanges{.count = 1, .gain_factor = Distribution::constant(1.1)};
  return study;
}

ExperimentDraw gain_fault(double factor) {
  ExperimentDraw draw;
  draw.index = 4;
  draw.world = 0;
  draw.kind = ExperimentKind::mpm;
  draw.mismatches = {{0, 0, MismatchParameter::gain, factor}};
  return draw;
}

/// E y^2 of each CV over the samples of the loop under white noise: with the pulse responses h(l) of the loop
/// to the noise of each CV, sum over k and l <= k of h(l)^2 sigma^2 / N. It is what Lyapunov's equation gives
/// for the loop from rest.
Eigen::VectorXd expected_squares(const Study& study, const ExperimentDraw& draw) {
  const Eigen::Index ny = study.cv_count(), N = study.simulation.samples;
  const Study plain = study;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(ny);
  const World world = draw_world(study, draw.world);
  const TransferMatrix plant = with_world_mismatches(world_plant(study, world), draw.mismatches);
  constexpr double kPulse = 1e-3;  // small, so that no limit is met
  for (Eigen::Index source = 0; source < ny; ++source) {
    LoopSignals signals{Eigen::MatrixXd::Zero(study.md_count(), N), Eigen::MatrixXd::Zero(ny, N),
                        Eigen::MatrixXd::Zero(ny, N)};
    signals.noise(source, 0) = kPulse;
    const Trajectory loop = run_closed_loop(plain, plant, signals, testing::kFactory);
    REQUIRE(loop.status == ControlStatus::ok);
    const double sigma = study.simulation.noise_standard_deviation(source);
    for (Eigen::Index lag = 0; lag < N; ++lag)
      squares += (static_cast<double>(N - lag) / static_cast<double>(N)) *
                 (loop.y.col(lag) * sigma / kPulse).cwiseAbs2();
  }
  return squares;
}

}  // namespace

TEST_CASE("cost of a fault: the ratio of the variances of a linear loop is that of Lyapunov's equation",
          "[fault_cost]") {
  const Study study = quiet_study();
  for (const double factor : {0.5, 1.6}) {
    const ExperimentDraw draw = gain_fault(factor);
    const Eigen::VectorXd exact =
        expected_squares(study, draw).cwiseQuotient(expected_squares(study, draw.without_faults()));
    SolverStatistics pilots;
    constexpr int kPairs = 200;
    const FaultCost cost = fault_cost(study, draw, kPairs, testing::kFactory, pilots);
    CHECK(pilots.steps == 2 * kPairs * study.simulation.samples);
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
      INFO("factor " << factor << ", CV " << cv << ": " << cost.variance_ratio(cv) << " and " << exact(cv));
      // A variance over 200 samples scatters by 15 %, its ratio over common noise by less: 200 pairs by 1 %.
      CHECK(cost.variance_ratio(cv) == Approx(exact(cv)).epsilon(0.03));
    }
    CHECK(cost.error > 0.0);
    CHECK(cost.error < 0.05 * cost.loss_ratio);
  }
}

TEST_CASE("cost of a fault: signs are kept, and without a fault there is none", "[fault_cost]") {
  const Study study = quiet_study();
  SolverStatistics pilots;
  const FaultCost none = fault_cost(study, basis_draw(0), 4, testing::kFactory, pilots);
  CHECK(pilots.steps == 0);
  CHECK(none.loss_ratio == 1.0);
  CHECK_FALSE(none.has_impact(1.2));
  FaultCost less;
  less.variance_ratio = Eigen::Vector2d(0.1, 1.0);
  CHECK_FALSE(less.has_impact(1.2));
  less.variance_ratio(1) = 1.3;
  CHECK(less.has_impact(1.2));
  less.variance_ratio(1) = 1.0;
  less.loss_ratio = 1.3;
  CHECK(less.has_impact(1.2));
}

TEST_CASE("cost of a CV: about the setpoint or outside of the limits, from the onset on", "[fault_cost]") {
  Study study = find_study("wood-berry");
  study.simulation.samples = 4;
  study.simulation.limit_steps.clear();
  study.controller.cv_soft = Limits::none(2);
  study.controller.cv_soft.upper(1) = 1.0;
  study.controller.setpoint_weight = Eigen::Vector2d(2.0, 0.0);
  const Eigen::MatrixXd y = (Eigen::MatrixXd(2, 4) << 9, 1, 2, kNaN, 9, 3, 1, -5).finished();
  const Eigen::MatrixXd y_set = (Eigen::MatrixXd(2, 4) << 0, 0, 4, 0, 0, 0, 0, 0).finished();
  const Eigen::VectorXd cost = cv_costs(study, y, y_set, 1);
  CHECK(cost(0) == Approx((1.0 + 4.0) / 2.0));  // two samples are there
  CHECK(cost(1) == Approx((4.0 + 0.0 + 0.0) / 3.0));
  CHECK(cost_floor(study)(0) == 0.0);
  CHECK(cost_floor(study)(1) == Approx(std::pow(study.simulation.noise_standard_deviation(1), 2)));
}

TEST_CASE("cost of a fault: movement of the setpoint, which hides a fault in a variance, is not in its cost",
          "[fault_cost]") {
  Study study = quiet_study();
  study.simulation.setpoint_steps = {{0, 20, 0.01}, {0, 110, -0.01}};
  study.diagnosis.variance_centre = VarianceCentre::mean;
  ExperimentDraw draw = gain_fault(0.4);
  draw.onset.sample = 150;
  SolverStatistics pilots;
  const FaultCost cost = fault_cost(study, draw, 20, testing::kFactory, pilots);
  INFO(cost.variance_ratio.transpose() << " and " << cost.cost_ratio.transpose());
  CHECK(std::abs(std::log(cost.cost_ratio(0))) > std::abs(std::log(cost.variance_ratio(0))));
  CHECK((cost.cost_ratio_error.array() > 0.0).all());
  FaultCost worse = cost;
  worse.loss_ratio = 1.0;
  worse.variance_ratio.setOnes();
  worse.cost_ratio = Eigen::Vector3d(1.0, 1.3, 1.0);
  CHECK_FALSE(worse.has_impact(1.2));
  CHECK(worse.has_impact(1.2, ImpactMeasure::cost));
}

TEST_CASE("cost of a loop: setpoints, soft limits, moves and economics in the weights of the controller",
          "[fault_cost]") {
  Study study = find_study("wood-berry");
  study.simulation.samples = 2;
  study.simulation.limit_steps.clear();
  study.controller.setpoint_weight = Eigen::Vector2d(2.0, 3.0);
  study.controller.slack_weight = Eigen::Vector2d(10.0, 1.0);
  study.controller.weight_convention = WeightConvention::squared;
  study.controller.move_suppression = Eigen::Vector2d(1.0, 2.0);
  study.controller.cv_soft = Limits::none(2);
  Trajectory loop;
  loop.y = (Eigen::Matrix2d() << 1.0, 2.0, 0.0, 0.5).finished();
  loop.y_set = Eigen::Matrix2d::Zero();
  loop.u = (Eigen::Matrix2d() << 0.0, 1.0, 0.0, 3.0).finished();
  const LoopCost cost = loop_cost(study, loop);
  CHECK(cost.cv(0) == Approx(4.0 * (1.0 + 4.0) / 2.0));
  CHECK(cost.cv(1) == Approx(9.0 * 0.25 / 2.0));
  CHECK(cost.violation.isZero(0));
  CHECK(cost.effort == Approx((1.0 * 1.0 + 4.0 * 9.0) / 2.0));
  CHECK(cost.total() == Approx(cost.cv.sum() + cost.effort));
  study.controller.cv_soft.upper(0) = 1.5;  // the second sample is 0.5 above it
  const LoopCost over = loop_cost(study, loop);
  CHECK(over.violation(0) == Approx(0.25));
  CHECK(over.cv(0) - cost.cv(0) == Approx(100.0 * 0.25 / 2.0));
}

}  // namespace mpm
