#include <cmath>
#include <numbers>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace {

using namespace mpm;

constexpr double kTs = 4.0;  // of the chapter 6 study

Study study_of(int samples) {
  Study study = find_study("chapter6");
  study.simulation.samples = samples;
  study.simulation.steps.resize(1);
  return study;
}

/// y_d of y3 in an experiment with this disturbance on it.
Eigen::RowVectorXd signal_of(const Study& study, Disturbance disturbance) {
  disturbance.cv = 2;
  ExperimentDraw draw;
  draw.index = 3;
  draw.kind = ExperimentKind::ud;
  draw.disturbances = {std::move(disturbance)};
  return unmeasured_disturbances(study, draw).row(2);
}

Disturbance direct(DisturbanceSignal signal) {
  return {0, 0, 0, DisturbanceModel::direct, {}, std::move(signal)};
}

Disturbance through(TransferFunction Gd, DisturbanceSignal signal) {
  return {0, 0, 0, DisturbanceModel::transfer_function, std::move(Gd), std::move(signal)};
}

TEST_CASE("disturbance signals: sine, ramp and steps are what they are called") {
  const Study study = study_of(60);
  const Eigen::RowVectorXd sine = signal_of(study, direct(Sine{0.2, 100.0}));
  const Eigen::RowVectorXd ramp = signal_of(study, direct(Ramp{0.01, 50.0}));
  const Eigen::RowVectorXd steps = signal_of(study, direct(StepSequence{{{10, 1.0}, {40, -0.5}}}));
  for (int k = 0; k < 60; ++k) {
    const double t = kTs * k;
    CHECK(sine(k) == Approx(0.2 * std::sin(2 * std::numbers::pi * t / 100.0)).margin(1e-14));
    CHECK(ramp(k) == Approx(t < 50 ? 0.0 : 0.01 * (t - 50)).margin(1e-15));
    CHECK(steps(k) == (k < 10 ? 0.0 : k < 40 ? 1.0 : -0.5));
  }
}

TEST_CASE("disturbance signals: a shared sequence is the same in every experiment, and no other's") {
  Study study = study_of(60);
  const auto v = [&study](std::int64_t index) {
    return disturbance_output(study, index, direct(WhiteNoise{}));
  };
  const Eigen::RowVectorXd own = v(3);
  CHECK(v(4) != own);
  study.disturbance.sequence = SignalSequence::shared;
  CHECK(v(4) == v(3));
  CHECK(v(3) != own);
  CHECK(signal_of(study, direct(WhiteNoise{})) == v(7));
  ++study.seed;
  const Eigen::RowVectorXd other = v(3);
  --study.seed;
  CHECK(other != v(3));
}

TEST_CASE("disturbance signals: a step through G_d is its step response, an integrator's a ramp") {
  const Study study = study_of(60);
  const StepSequence step{{{10, 2.0}}};
  Disturbance first_order{0, 1.5, 30.0};
  first_order.signal = step;
  const Eigen::RowVectorXd lag = signal_of(study, first_order);
  // (0.3 s + 2)/(100 s^2 + 30 s) of table 5.2 and (-0.2 s + 0.15)/(10 s) of table 5.11, in partial fractions.
  const Eigen::RowVectorXd second =
      signal_of(study, through({Eigen::Vector2d(0.3, 2), Eigen::Vector3d(100, 30, 0)}, step));
  const Eigen::RowVectorXd feedthrough =
      signal_of(study, through({Eigen::Vector2d(-0.2, 0.15), Eigen::Vector2d(10, 0)}, step));
  for (int k = 0; k < 60; ++k) {
    const double t = kTs * (k - 10);  // the hold begins at sample 10, after the output of sample 10 is taken
    if (t <= 0) {
      CHECK((lag(k) == 0 && second(k) == 0 && feedthrough(k) == 0));
      continue;
    }
    CHECK(lag(k) == Approx(3.0 * (1 - std::exp(-t / 30))));
    const double c = 2.0 / 30.0;  // G = c/s + (0.003 - c)/(s + 0.3)
    const double d = (0.003 - c) / 0.3;
    CHECK(second(k) == Approx(2 * (c * t + d * (1 - std::exp(-0.3 * t)))));
    CHECK(feedthrough(k) == Approx(2 * (-0.02 + 0.015 * t)));
  }
}

TEST_CASE("disturbance signals: a sine through G_d settles at the amplitude |G_d|") {
  const Study study = study_of(2000);
  const double period = 400.0;
  Disturbance lag{0, 1.5, 60.0};
  lag.signal = Sine{0.2, period};
  const Eigen::RowVectorXd y =
      signal_of(study, lag).tail(1000);  // 10 periods; 66 time constants after the start
  const double expected =
      0.2 * std::abs(TransferFunction::first_order(1.5, 60.0)({0.0, 2 * std::numbers::pi / period}));
  // The hold of 4 min scales a sine of 400 min by sinc(0.01) = 1 - 1.6e-4.
  CHECK(std::sqrt(2 * y.squaredNorm() / 1000) == Approx(expected).epsilon(1e-3));
}

TEST_CASE("disturbance signals: held white noise keeps each value, and the factor is its deviation") {
  Study study = study_of(6000);
  study.disturbance.v_standard_deviation = 0.5;
  const Eigen::RowVectorXd v = signal_of(study, direct(WhiteNoise{3.0, 6}));
  for (int k = 0; k < 6000; ++k)
    CHECK(v(k) == v(k - k % 6));
  // 1000 independent values know their deviation to 2.2 %; five of them.
  CHECK(std::sqrt(v.squaredNorm() / 6000) == Approx(1.5).epsilon(0.11));
}

TEST_CASE("disturbance signals: disturbances add up, each with a sequence of its own") {
  const Study study = study_of(500);
  ExperimentDraw draw;
  draw.index = 3;
  draw.kind = ExperimentKind::ud;
  draw.disturbances = {{2, 1.0, 40.0}, {2, 1.0, 40.0}, {4, 1.0, 40.0}};
  const Eigen::MatrixXd three = unmeasured_disturbances(study, draw);
  draw.disturbances.resize(1);
  const Eigen::MatrixXd one = unmeasured_disturbances(study, draw);
  const Eigen::RowVectorXd second = three.row(2) - one.row(2);
  CHECK(one.row(4).isZero());
  CHECK((second - one.row(2)).norm() > 0.5 * one.row(2).norm());
  CHECK((second - three.row(4)).norm() > 0.5 * three.row(4).norm());
}

TEST_CASE("a scenario is the same loop as its faults made by hand") {
  Study study = study_of(40);
  study.scenarios = {{"a",
                      "",
                      {{2, 0, MismatchParameter::gain, 1.4}, {2, 4, MismatchParameter::dead_time, 2.0}},
                      {{1, 0.5, 60.0}},
                      {}}};
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const Trajectory scenario = simulate_experiment(study, draw_experiment(study, 0), factory);

  TransferMatrix plant = study.plant.G;
  plant(2, 0) = TransferFunction::first_order(1.4 * 3.66, 9.0, 2.0);
  plant(2, 4) = TransferFunction::first_order(1.27, 6.0, 2.0);
  ExperimentDraw by_hand;
  by_hand.index = 0;
  by_hand.kind = ExperimentKind::ud;
  by_hand.disturbances = {{1, 0.5, 60.0}};
  const Trajectory expected = run_closed_loop(
      study, plant,
      {measured_disturbances(study), measurement_noise(study, 0), unmeasured_disturbances(study, by_hand)},
      factory);
  REQUIRE(scenario.status == ControlStatus::ok);
  CHECK(scenario.y == expected.y);
  CHECK(scenario.u == expected.u);
}

}  // namespace
