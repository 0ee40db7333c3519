#include <memory>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/ode_plant.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/scenarios/study_texts.hpp"

// The closed loop takes any plant.

namespace mpm {
namespace {

Study tank_study() {
  return parse_study(testing::project_file("tests/scenarios/data/quadruple-tank.toml"),
                     "quadruple-tank.toml");
}

LoopSignals quiet(const Study& study) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(study.cv_count(), study.simulation.samples);
  return {Eigen::MatrixXd::Zero(study.md_count(), study.simulation.samples), none, none};
}

std::unique_ptr<Plant> nonlinear_tank(const QuadrupleTankParameters& parameters) {
  return std::make_unique<DeviationPlant>(
      std::make_unique<OdePlant>(std::make_shared<QuadrupleTank>(parameters), 10.0),
      quadruple_tank_operating_point());
}

/// A plant that stands still and cannot be integrated beyond its third sample.
class StuckPlant final : public Plant {
 public:
  Eigen::Index output_count() const override { return 4; }
  Eigen::Index input_count() const override { return 4; }
  double sample_time() const override { return 10; }
  void reset(const Eigen::Ref<const Eigen::VectorXd>&) override { samples_ = 0; }
  const Eigen::VectorXd& output() const override { return output_; }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>&) override {
    return ++samples_ > 3 ? PlantStatus::failed : PlantStatus::ok;
  }

 private:
  Eigen::VectorXd output_ = Eigen::VectorXd::Zero(4);
  int samples_ = 0;
};

/// Rests nowhere.
class RestlessPlant final : public Plant {
 public:
  Eigen::Index output_count() const override { return 4; }
  Eigen::Index input_count() const override { return 4; }
  double sample_time() const override { return 10; }
  void reset(const Eigen::Ref<const Eigen::VectorXd>&) override {
    throw NoSteadyState("level of the plant", "one that rises", "one that rests");
  }
  const Eigen::VectorXd& output() const override { return output_; }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>&) override { return PlantStatus::ok; }

 private:
  Eigen::VectorXd output_ = Eigen::VectorXd::Zero(4);
};

}  // namespace

TEST_CASE("closed loop: a linear plant gives the same bits by its matrix and as a plant") {
  Study study = find_study("chapter6");
  study.simulation.samples = 60;
  study.simulation.steps.resize(1);
  const LoopSignals signals{measured_disturbances(study), measurement_noise(study, 1),
                            Eigen::MatrixXd::Zero(7, 60)};
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const Trajectory expected = run_closed_loop(study, study.plant.G, signals, factory);
  LinearPlant plant(study.plant.G, study.controller.sample_time);
  const Trajectory loop = run_closed_loop(study, plant, signals, factory);
  REQUIRE(loop.status == ControlStatus::ok);
  CHECK(loop.y == expected.y);
  CHECK(loop.u == expected.u);
}

TEST_CASE("closed loop: near the operating point the nonlinear tank behaves as its linearisation") {
  Study study = tank_study();
  study.controller.mv_cost.setZero();  // targets at the operating point
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const auto difference = [&](double size) {
    study.controller.cv_soft.lower.setConstant(-0.5 * size);
    study.controller.cv_soft.upper.setConstant(0.5 * size);
    LoopSignals signals = quiet(study);
    signals.y_d.row(0).tail(80).setConstant(size);  // disturbances of levels, beyond their limits
    signals.y_d.row(3).tail(40).setConstant(-size);
    const auto plant = nonlinear_tank(quadruple_tank_parameters("table-2.6"));
    const Trajectory nonlinear = run_closed_loop(study, *plant, signals, factory);
    const Trajectory linear = run_closed_loop(study, study.plant.G, signals, factory);
    REQUIRE(nonlinear.status == ControlStatus::ok);
    REQUIRE(linear.status == ControlStatus::ok);
    CHECK(linear.u.cwiseAbs().maxCoeff() > 0.01 * size);  // the controller had to act
    return (nonlinear.y - linear.y).cwiseAbs().maxCoeff() / size;
  };
  // What is nonlinear is of second order: relative to the disturbance a tenth of it for a tenth of the size.
  const double large = difference(1.0);
  const double small = difference(0.1);
  INFO(large << " and " << small);
  CHECK(large > 1e-3);
  CHECK(small < 0.2 * large);
}

TEST_CASE("closed loop: levels at their limits are held without offset on the nonlinear tank with mismatch") {
  Study study = tank_study();
  study.simulation.samples = 400;
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const QuadrupleTankParameters original = quadruple_tank_parameters("table-2.6");
  for (const QuadrupleTankParameters& parameters :
       {original, with_parameter(original, "cd1", 3.5), with_parameter(original, "A3", 40),
        quadruple_tank_parameters("table-3.1")}) {
    const auto plant = nonlinear_tank(parameters);
    const Trajectory loop = run_closed_loop(study, *plant, quiet(study), factory);
    REQUIRE(loop.status == ControlStatus::ok);
    // The pumps pay: the optimizer drives the levels to limits, and the bias of the outputs takes the offset
    // out.
    const Eigen::VectorXd last = loop.y.rightCols<1>();
    INFO("levels " << last.transpose());
    CHECK(((last.array() - 1.0).abs() < 1e-3).count() >= 2);
    CHECK((last.array() < 1.0 + 1e-3).all());
  }
}

TEST_CASE("closed loop: a disturbance within the plant spreads, one of the measurement does not") {
  Study study = tank_study();
  study.controller.mv_cost.setZero();
  study.controller.cv_soft = Limits::none(4);  // no reason to move
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const auto run = [&](const LoopSignals& signals) {
    const auto plant = nonlinear_tank(quadruple_tank_parameters("table-3.1"));
    return run_closed_loop(study, *plant, signals, factory);
  };
  LoopSignals measured = quiet(study);
  measured.y_d.row(3).tail(90).setConstant(2);
  LoopSignals within = quiet(study);
  within.within_plant.setZero(8, study.simulation.samples);
  within.within_plant.row(7).tail(90).setConstant(2);  // D_4
  const Trajectory only_h4 = run(measured);
  const Trajectory spread = run(within);
  REQUIRE(only_h4.u.cwiseAbs().maxCoeff() < 1e-9);
  REQUIRE(spread.u.cwiseAbs().maxCoeff() < 1e-9);
  CHECK(only_h4.y.row(1).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(spread.y.row(1).maxCoeff() > 0.5);  // the water of tank 4 runs through tank 2
  CHECK(spread.y.row(0).cwiseAbs().maxCoeff() < 1e-6);
  CHECK(only_h4.y(3, 99) == Approx(2).margin(1e-6));
  CHECK(spread.y(3, 99) < 0.1);  // and out again

  within.within_plant.setZero(3, study.simulation.samples);
  CHECK_THROWS_WITH(run(within),
                    Catch::Contains("disturbances within the plant") && Catch::Contains("8 x 120"));
}

TEST_CASE("closed loop: it ends as failed where the plant does") {
  const Study study = tank_study();
  StuckPlant plant;
  const Trajectory loop = run_closed_loop(study, plant, quiet(study), qp_solver_factory("active-set"));
  CHECK(loop.status == ControlStatus::failed);
  CHECK(loop.failure == LoopFailure::plant);
  CHECK(loop.samples_done == 3);
  CHECK(loop.u.rightCols(97).isZero(0));
}

TEST_CASE("closed loop: it fails before its first sample where the plant cannot rest") {
  const Study study = tank_study();
  RestlessPlant plant;
  const Trajectory loop = run_closed_loop(study, plant, quiet(study), qp_solver_factory("active-set"));
  CHECK(loop.status == ControlStatus::failed);
  CHECK(loop.failure == LoopFailure::no_steady_state);
  CHECK_THAT(loop.message, Catch::Contains("level of the plant"));
  CHECK(loop.samples_done == 0);
  CHECK(loop.y.isZero(0));
  CHECK(loop.y.cols() == study.simulation.samples);
}

TEST_CASE("closed loop: a plant that does not fit the study is refused") {
  using Catch::Contains;
  const Study study = tank_study();
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const auto process = std::make_shared<QuadrupleTank>(quadruple_tank_parameters("table-2.6"));
  OdePlant hurried(process, 5.0);
  CHECK_THROWS_WITH(run_closed_loop(study, hurried, quiet(study), factory),
                    Contains("sample time of the plant") && Contains("5"));
  LinearPlant narrow(TransferMatrix(4, 3), 10.0);
  CHECK_THROWS_WITH(run_closed_loop(study, narrow, quiet(study), factory), Contains("inputs of the plant"));
  LinearPlant low(TransferMatrix(3, 4), 10.0);
  CHECK_THROWS_WITH(run_closed_loop(study, low, quiet(study), factory), Contains("outputs of the plant"));
}

}  // namespace mpm
