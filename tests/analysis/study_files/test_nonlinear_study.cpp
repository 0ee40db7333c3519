#include <memory>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "plants/models/catalogue.hpp"
#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/ode_plant.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/scenarios/study_texts.hpp"

// Studies whose loops run on a nonlinear plant.

namespace mpm {
namespace {

using namespace testing;

constexpr const char* kTankCounts = "[experiments]\nmpm = 1\nud = 0\nmpm_ud = 0\n";

/// The tank study with these keys in [plant] and these scenarios.
std::string tank_text(const std::string& plant, const std::string& scenarios) {
  const std::string text =
      replaced(project_file("tests/scenarios/data/quadruple-tank.toml"), kTankCounts, scenarios);
  return replaced(text, "catalogue = \"quadruple-tank\"\n", "catalogue = \"quadruple-tank\"\n" + plant);
}

const std::string kNonlinear = "simulated = \"nonlinear\"\n";

Study tank(const std::string& scenarios, const std::string& plant = kNonlinear) {
  return parse_study(tank_text(plant, scenarios), "s.toml");
}

std::string refused(const std::string& plant, const std::string& scenario) {
  const std::string message = refusal(tank_text(plant, "[[scenario]]\nname = 'a'\n" + scenario));
  return message.substr(message.find(' ') + 1);
}

TEST_CASE("the keys of a nonlinear plant land in their place", "[nonlinear]") {
  const Study study = tank(
      "[[scenario]]\nname = 'a'\naffected = ['h1']\nparameter = [{name = 'cd1', value = 7.86}, {name = 'A4', "
      "factor = 0.125}]\n[[scenario]]\nname = 'b'\naffected = ['h2', 'h4']\n"
      "disturbance = [{input = 'D4', gain = 8, time_constant = 70}]\n",
      kNonlinear +
          "integrator = 'bdf'\nrelative_tolerance = 1e-6\nabsolute_tolerance = 1e-5\nstep_limit = 77\n");
  REQUIRE(study.nonlinear.has_value());
  CHECK(study.nonlinear->integration.method == OdeMethod::bdf);
  CHECK(study.nonlinear->integration.relative_tolerance == 1e-6);
  CHECK(study.nonlinear->integration.absolute_tolerance == 1e-5);
  CHECK(study.nonlinear->integration.step_limit == 77);
  const ExperimentDraw a = draw_experiment(study, 0);
  REQUIRE(a.parameters.size() == 2);
  CHECK(a.parameters[0].value == 7.86);
  CHECK(a.parameters[1].value == 4);
  CHECK(a.kind == ExperimentKind::mpm);
  CHECK(a.true_cv() == 0);
  const ExperimentDraw b = draw_experiment(study, 1);
  CHECK(b.kind == ExperimentKind::ud);
  CHECK(b.affected().size() == 2);
  CHECK(*b.disturbances.front().inner_input == 7);  // F1 ... F4, D1 ... D4
  CHECK(unmeasured_disturbances(study, b).isZero(0));
  CHECK_FALSE(disturbances_within_plant(study, b).row(7).isZero(0));
  CHECK(disturbances_within_plant(study, b).topRows(7).isZero(0));
}

TEST_CASE("what a nonlinear study cannot be is refused", "[nonlinear]") {
  CHECK(
      refused("", "affected = ['h1']\nparameter = [{name = 'cd1', value = 2}]\n") ==
      "scenario[0].parameter: found parameters of a plant that is simulated with its linear model; allowed: "
      "plant.simulated = \"nonlinear\", plant.fmu or plant.program");
  CHECK(refused("step_limit = 5\n", "") ==
        "plant.step_limit: found a key of the integration of a nonlinear plant; allowed: plant.simulated = "
        "\"nonlinear\"");
  CHECK(refused("integrator = 'bdf'\n", "") ==
        "plant.integrator: found a key of the integration of a nonlinear plant; allowed: plant.simulated = "
        "\"nonlinear\"");
  CHECK(
      refused(kNonlinear, "parameter = [{name = 'cd1', value = 2}]\n") ==
      "scenario[0].affected: found nothing; allowed: the CVs that the fault of the nonlinear plant affects");
  CHECK(refused(kNonlinear, "parameter = [{name = 'cd1', value = 2, factor = 2}]\n") ==
        "scenario[0].parameter[0]: found both value and factor; allowed: exactly one of the two");
  CHECK(refused(kNonlinear, "parameter = [{name = 'cd1', value = 2}, {name = 'cd1', value = 3}]\n") ==
        "scenario[0].parameter[1].name: found 'cd1' a second time; allowed: every parameter once");
  CHECK_THAT(refused(kNonlinear, "parameter = [{name = 'cd1', value = -2}]\n"),
             Catch::Contains("found -2; allowed: > 0"));
  CHECK_THAT(refused(kNonlinear, "parameter = [{name = 'cd9', value = 2}]\n"),
             Catch::Contains("scenario[0].parameter[0].name: found 'cd9'"));
  CHECK_THAT(refused(kNonlinear, "disturbance = [{input = 'D5', white = 1}]\n"),
             Catch::Contains("scenario[0].disturbance[0].input: found 'D5'"));
  CHECK(refused(kNonlinear, "mismatch = [{cv = 'h1', input = 'v1', gain_factor = 2}]\n") ==
        "scenario[0].mismatch: found channels of a plant that is simulated as nonlinear; allowed: parameter");
  CHECK_THAT(refusal(tank_text(kNonlinear, kTankCounts)), Catch::Contains("random mismatches"));
  const std::string linear = replaced(find_study("chapter6").source, "catalogue = \"shell-7x3\"",
                                      "catalogue = \"shell-7x3\"\nsimulated = \"nonlinear\"");
  CHECK_THAT(refusal(linear),
             Catch::Contains("plant.simulated: found 'nonlinear' for 'shell-7x3', which is linear"));
}

TEST_CASE("a scenario's parameter change is the plant made by hand", "[nonlinear]") {
  const Study study =
      tank("[[scenario]]\nname = 'a'\naffected = ['h1']\nparameter = [{name = 'cd1', value = 3.5}]\n");
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const ExperimentDraw draw = draw_experiment(study, 0);
  const Trajectory loop = simulate_experiment(study, draw, factory);
  REQUIRE(loop.status == ControlStatus::ok);
  const QuadrupleTankParameters nominal = quadruple_tank_parameters("table-2.6");
  DeviationPlant plant(
      std::make_unique<OdePlant>(std::make_shared<QuadrupleTank>(with_parameter(nominal, "cd1", 3.5)), 10.0,
                                 OdeOptions{}, std::make_shared<QuadrupleTank>(nominal)),
      quadruple_tank_operating_point());
  const LoopSignals signals{measured_disturbances(study), measurement_noise(study, 0),
                            Eigen::MatrixXd::Zero(4, study.simulation.samples)};
  const Trajectory by_hand = run_closed_loop(study, plant, signals, factory);
  CHECK(loop.y == by_hand.y);
  CHECK(loop.u == by_hand.u);
  CHECK(loop.y != simulate_experiment(study, basis_draw(), factory).y);
}

TEST_CASE("a nonlinear study with small steps comes near the linear one", "[nonlinear]") {
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const auto difference = [&](double size) {
    Study study = find_study("chapter5-tank");
    study.simulation.samples = 200;
    study.simulation.noise_standard_deviation.setZero();
    std::erase_if(study.simulation.setpoint_steps, [](const SignalStep& step) { return step.sample >= 200; });
    for (SignalStep& step : study.simulation.setpoint_steps)
      step.level *= size;
    const Trajectory nonlinear = simulate_experiment(study, basis_draw(), factory);
    study.nonlinear.reset();
    const Trajectory linear = simulate_experiment(study, basis_draw(), factory);
    return (nonlinear.y - linear.y).cwiseAbs().maxCoeff() / size;
  };
  // What is nonlinear is of second order: a tenth of it, relative to the steps, for a tenth of their size.
  const double large = difference(0.5);
  CHECK(large > 1e-3);
  CHECK(difference(0.05) < 0.2 * large);
}

TEST_CASE("the integrator, its tolerances and its limit of steps act", "[nonlinear]") {
  const QpSolverFactory factory = qp_solver_factory("active-set");
  Study study = find_study("chapter5-tank");
  study.simulation.samples = 60;
  std::erase_if(study.simulation.setpoint_steps, [](const SignalStep& step) { return step.sample >= 60; });
  const Eigen::MatrixXd y = simulate_experiment(study, basis_draw(), factory).y;
  const auto difference = [&](const OdeOptions& options) {
    study.nonlinear->integration = options;
    return (simulate_experiment(study, basis_draw(), factory).y - y).cwiseAbs().maxCoeff();
  };
  const double other_method = difference({.method = OdeMethod::bdf});
  CHECK(other_method > 0.0);
  CHECK(other_method < 1e-5);

  const OdeMethod method = GENERATE(OdeMethod::runge_kutta, OdeMethod::bdf);
  const double coarse =
      difference({.method = method, .relative_tolerance = 1e-3, .absolute_tolerance = 1e-3});
  CHECK(coarse > 1e-8);  // Runge-Kutta takes one step a sample then, which errs by 6e-8 cm
  CHECK(coarse < 0.5);
  study.nonlinear->integration = {.method = method, .step_limit = 1};
  CHECK(simulate_experiment(study, basis_draw(), factory).status == ControlStatus::failed);
}

TEST_CASE("the external flows of the tank are measured disturbances where the catalogue says so",
          "[nonlinear]") {
  const PlantModel plant = benchmark_plant("quadruple-tank-flows");
  REQUIRE(plant.mds.size() == 2);
  const QuadrupleTank process(quadruple_tank_parameters("table-2.6"));
  const Eigen::MatrixXd gain = process.linearised(quadruple_tank_operating_point()).static_gain();
  CHECK(plant.G.static_gain() == gain.leftCols(6));
  CHECK(nonlinear_benchmark_plant("quadruple-tank-flows")->inner_inputs.size() == 6);
  CHECK_FALSE(nonlinear_benchmark_plant("shell-7x3").has_value());
}

}  // namespace
}  // namespace mpm
