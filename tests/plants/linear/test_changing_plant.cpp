#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/linear/changing_plant.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/nonlinear/ode_plant.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"

namespace {

using namespace mpm;

constexpr double kSampleTime = 2.0;

TransferMatrix two_by_two() {
  return {{TransferFunction::first_order(2.0, 10.0, 6.0), TransferFunction::first_order(-1.0, 20.0)},
          {TransferFunction::zero(), TransferFunction::first_order(0.5, 5.0, 3.0)}};
}

/// Outputs under inputs that move, from the steady state of (1, -1).
Eigen::MatrixXd outputs_of(Plant& plant, Eigen::Index samples) {
  plant.reset(Eigen::Vector2d(1.0, -1.0));
  Eigen::MatrixXd y(2, samples);
  for (Eigen::Index k = 0; k < samples; ++k) {
    y.col(k) = plant.output();
    plant.advance(Eigen::Vector2d(std::sin(0.3 * static_cast<double>(k)), k % 7 < 3 ? -1.0 : 0.4));
  }
  return y;
}

Eigen::VectorXd step_at(Eigen::Index sample, Eigen::Index samples) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(samples);
  share.tail(samples - sample).setOnes();
  return share;
}

TEST_CASE("changing plant: it is the plant before at share 0 and the plant after at share 1") {
  const TransferMatrix before = two_by_two();
  TransferMatrix after = before;
  after(0, 0) = before(0, 0).with_gain_scaled(1.4).with_time_scaled(2.0).with_dead_time_shifted(4.0);
  after(1, 1) = before(1, 1).with_gain_scaled(-1.0);
  LinearPlant plant_before(before, kSampleTime), plant_after(after, kSampleTime);
  ChangingPlant never(before, after, kSampleTime, Eigen::VectorXd::Zero(1));
  ChangingPlant always(before, after, kSampleTime, Eigen::VectorXd::Ones(1));
  CHECK((outputs_of(never, 80) - outputs_of(plant_before, 80)).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((outputs_of(always, 80) - outputs_of(plant_after, 80)).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("changing plant: without a changed channel it is the plant itself") {
  LinearPlant plant(two_by_two(), kSampleTime);
  ChangingPlant same(two_by_two(), two_by_two(), kSampleTime, step_at(5, 20));
  CHECK(outputs_of(same, 40) == outputs_of(plant, 40));
}

TEST_CASE("changing plant: at rest only a gain is seen, through the lag of its channel") {
  const TransferMatrix before{{TransferFunction::first_order(2.0, 10.0, 4.0)}};
  const TransferMatrix dynamics{{TransferFunction::first_order(2.0, 30.0, 10.0)}};
  const TransferMatrix gain{{TransferFunction::first_order(3.0, 10.0, 4.0)}};
  const Eigen::VectorXd u = Eigen::VectorXd::Constant(1, 1.5);
  ChangingPlant other_dynamics(before, dynamics, kSampleTime, step_at(10, 60));
  ChangingPlant other_gain(before, gain, kSampleTime, step_at(10, 60));
  other_dynamics.reset(u);
  other_gain.reset(u);
  for (int k = 0; k < 60; ++k) {
    CHECK(other_dynamics.output()(0) == Approx(3.0).epsilon(1e-13));
    // 3 before, 4.5 at last: (3 - 2) 1.5 through the dead time of 4 and the lag of 10, from sample 10 on.
    const double t = kSampleTime * (k - 10) - 4.0;
    CHECK(other_gain.output()(0) == Approx(3.0 + (t > 0 ? 1.5 * (1.0 - std::exp(-t / 10.0)) : 0.0)));
    other_dynamics.advance(u);
    other_gain.advance(u);
  }
}

TEST_CASE("changing plant: what it refuses") {
  const TransferMatrix plant = two_by_two();
  CHECK_THROWS_AS(ChangingPlant(plant, TransferMatrix(2, 1), kSampleTime, Eigen::VectorXd::Zero(1)),
                  InputError);
  CHECK_THROWS_AS(ChangingPlant(plant, plant, kSampleTime, Eigen::VectorXd(0)), InputError);
  CHECK_THROWS_AS(ChangingPlant(plant, plant, kSampleTime, Eigen::VectorXd::Constant(3, 1.1)), InputError);
}

TEST_CASE("ode plant: with an onset it is the one plant before it and goes on as the other from its state") {
  const auto tank = [](double factor) {
    const QuadrupleTankParameters nominal = quadruple_tank_parameters("table-2.6");
    return std::make_shared<const QuadrupleTank>(with_parameter(nominal, "cd1", factor * 3.145));
  };
  const auto nominal = tank(1.0), changed = tank(1.5);
  constexpr Eigen::Index kOnset = 6;
  OdePlant plant(changed, 5.0, {}, nominal, kOnset), before(nominal, 5.0), after(changed, 5.0);
  const Eigen::VectorXd rest = quadruple_tank_operating_point();
  const Eigen::VectorXd input = 1.02 * rest;
  plant.reset(rest);
  before.reset(rest);
  for (Eigen::Index k = 0; k < 12; ++k) {
    if (k == kOnset)
      after.set_state(before.state());
    OdePlant& expected = k < kOnset ? before : after;
    CHECK((plant.state() - expected.state()).cwiseAbs().maxCoeff() == 0.0);
    plant.advance(input);
    expected.advance(input);
  }
  CHECK_THROWS_AS(OdePlant(changed, 5.0, {}, nominal, -1), InputError);
}

}  // namespace
