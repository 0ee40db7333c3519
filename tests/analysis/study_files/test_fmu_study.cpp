#include <string>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/scenarios/study_texts.hpp"

// Studies whose plant is an FMU: that of tests/plants/fmu.

namespace mpm {
namespace {

using namespace testing;
using Catch::Contains;

constexpr const char* kSimulated = "simulated = \"nonlinear\"";

/// chapter5-tank on the FMU in place of the equations.
std::string fmu_study_text() {
  const std::string table = R"(
[plant.fmu]
file = ")" MPMBENCH_TANK_FMU R"("
settle = 5000
input = [{name = "v1", operating = 3.2}, {name = "v2", operating = 3.15}, {name = "x1", operating = 0.43},
         {name = "x2", operating = 0.34}, {name = "fourth", variable = "D4", operating = 0}]
output = [{name = "h1", variable = "level[1]"}, {name = "h2", variable = "level[2]"},
          {name = "h3", variable = "level[3]"}, {name = "h4", variable = "level[4]"}]
parameter = [{name = "A1", value = 28}, {name = "A2", value = 32}, {name = "A3", value = 28},
  {name = "A4", value = 32}, {name = "cd1", value = 3.145}, {name = "cd2", value = 2.525},
  {name = "cd3", value = 3.145}, {name = "cd4", value = 2.525}, {name = "exp1", value = 0.5},
  {name = "exp2", value = 0.5}, {name = "exp3", value = 0.5}, {name = "exp4", value = 0.5},
  {name = "k1", value = 3.14}, {name = "k2", value = 3.29}]
)";
  const std::string text = find_study("chapter5-tank").source;
  return replaced(text.substr(0, text.find("[[scenario]]")), kSimulated, table) + R"(
[[scenario]]
name = "M"
affected = ["h1"]
parameter = [{name = "cd1", factor = 1.2}]
[[scenario]]
name = "D"
affected = ["h2", "h4"]
disturbance = [{input = "INNER", white = 0.5, hold = 5}]
)";
}

Study fmu_study() {
  return parse_study(replaced(fmu_study_text(), "INNER", "fourth"), "s.toml");
}

Study built_in_study() {
  const std::string text = replaced(fmu_study_text(), "INNER", "D4");
  const std::size_t begin = text.find("[plant.fmu]"), end = text.find("[controller]");
  return parse_study(text.substr(0, begin) + kSimulated + "\n" + text.substr(end), "s.toml");
}

TEST_CASE("an FMU of the nonlinear tank gives the loops of the built-in one", "[fmu]") {
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const Study fmu = fmu_study(), built_in = built_in_study();
  // Ours errs by some 1e-9 cm (docs/plants.md), and the loop, which is stable, by a few times that.
  constexpr double kIntegrators = 1e-8;
  for (const std::int64_t index : {-1, 0, 1}) {
    const auto draw_of = [index](const Study& study) {
      return index < 0 ? basis_draw() : draw_experiment(study, index);
    };
    const Trajectory one = simulate_experiment(fmu, draw_of(fmu), factory);
    const Trajectory other = simulate_experiment(built_in, draw_of(built_in), factory);
    REQUIRE(one.status == ControlStatus::ok);
    REQUIRE(other.status == ControlStatus::ok);
    CHECK((one.y - other.y).cwiseAbs().maxCoeff() < kIntegrators);
    CHECK((one.u - other.u).cwiseAbs().maxCoeff() < kIntegrators);
    CHECK(one.y == simulate_experiment(fmu, draw_of(fmu), factory).y);  // again, to the bit
  }
}

TEST_CASE("an FMU in a world has the loops of the built-in tank in the same world", "[fmu][world]") {
  const QpSolverFactory factory = qp_solver_factory("active-set");
  Study fmu = fmu_study(), built_in = built_in_study();
  for (Study* study : {&fmu, &built_in})
    study->world = WorldRanges{.count = 2,
                               .plant_parameters = {{"cd1", Distribution::uniform(0.9, 1.1)},
                                                    {"A2", Distribution::uniform(0.9, 1.1)}}};
  for (const int world : {0, 1}) {
    const Trajectory one = simulate_experiment(fmu, basis_draw(world), factory);
    const Trajectory other = simulate_experiment(built_in, basis_draw(world), factory);
    REQUIRE(one.status == ControlStatus::ok);
    // As without a world, and the error with which the FMU comes to rest at its operating point.
    CHECK((one.y - other.y).cwiseAbs().maxCoeff() < 1e-6);
    ExperimentDraw faulty = draw_experiment(fmu, 0);
    faulty.world = world;
    const Trajectory changed = simulate_experiment(fmu, faulty, factory);
    CHECK((changed.y - simulate_experiment(built_in, faulty, factory).y).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((changed.y - one.y).cwiseAbs().maxCoeff() > 1e-3);
  }
}

TEST_CASE("a study with an FMU can be read without it, until a loop is simulated", "[fmu]") {
  const std::string text =
      replaced(replaced(fmu_study_text(), "INNER", "fourth"), MPMBENCH_TANK_FMU, "not_here/tank.fmu");
  const Study study = parse_study(text, "s.toml");
  CHECK(study.nonlinear->model.inner_inputs == std::vector<std::string>{"fourth"});
  CHECK_THROWS_WITH(
      simulate_experiment(study, basis_draw(), qp_solver_factory("active-set")),
      Contains("s.toml:") && Contains("plant.fmu.file: found 'not_here/tank.fmu', which is no file"));
}

TEST_CASE("the keys of a program as the plant land in their place", "[fmu]") {
  const std::string base = project_file("tests/scenarios/data/quadruple-tank.toml");
  const auto text = [&](const std::string& command) {
    return replaced(base.substr(0, base.find("[experiments]")), "catalogue = \"quadruple-tank\"\n",
                    "catalogue = \"quadruple-tank\"\n[plant.program]\ncommand = " + command + R"(
settle = 100
input = [{name = "x1", operating = 0.43}, {name = "v2", operating = 3.15}, {name = "v1", operating = 3.2},
         {name = "rain", operating = 0.5}, {name = "x2", operating = 0.34}]
parameter = [{name = "cd 1", value = 3.145}]
)") + "[[scenario]]\nname = 'a'\naffected = ['h1']\nparameter = [{name = 'cd 1', factor = 2}]\n";
  };
  const Study study = parse_study(text("[\"sh\", \"-c\", \"-c\"]"), "s.toml");
  REQUIRE(study.nonlinear.has_value());
  const NonlinearModel& model = study.nonlinear->model;
  CHECK(model.operating_input == (Eigen::VectorXd(5) << 3.2, 3.15, 0.43, 0.34, 0.5).finished());
  CHECK(model.inner_inputs == std::vector<std::string>{"rain"});
  CHECK(model.parameters == std::vector<NonlinearModel::Parameter>{{"cd 1", 3.145}});
  CHECK(model.foreign->options().settle == 100);
  CHECK(model.foreign->output_count() == 4);
  CHECK_THAT(refusal(text("[]")),
             Contains("plant.program.command: found") && Contains("the program and its"));
  CHECK_THAT(refusal(text("[\"sh\", 1]")), Contains("plant.program.command: found"));
  CHECK_THAT(refusal(text("\"sh\"")), Contains("plant.program.command: found"));
  CHECK_THAT(refusal(text("['a']\n[plant.fmu]\nfile = 'b'\n[plant.program.more]")),
             Contains("plant.program"));
}

TEST_CASE("what a study with an FMU cannot be is refused", "[fmu]") {
  const std::string text = replaced(fmu_study_text(), "INNER", "fourth");
  const auto refused = [&](const std::string& from, const std::string& to) {
    const std::string message = refusal(replaced(text, from, to));
    return message.substr(message.find(' ') + 1);
  };
  CHECK(refused("catalogue", "simulated = \"nonlinear\"\ncatalogue") ==
        "plant.simulated: found a key beside plant.fmu; allowed: plant.fmu alone: it integrates itself");
  CHECK(refused("{name = \"v2\", operating = 3.15}, ", "") ==
        "plant.fmu.input: found no entry for 'v2'; allowed: one for each MV and MD of the plant");
  CHECK(refused("{name = \"v2\", operating = 3.15}", "{name = \"v1\", operating = 3.15}") ==
        "plant.fmu.input[1].name: found 'v1' a second time; allowed: every name once");
  CHECK_THAT(refused("{name = \"h1\", variable", "{name = \"h9\", variable"),
             Contains("plant.fmu.output[0].name: found 'h9'"));
  CHECK_THAT(refused("settle = 5000", "settle = 0"), Contains("plant.fmu.settle: found 0"));
  CHECK_THAT(refused("settle = 5000", "settle = 5\ntime_limit = 1e6"),
             Contains("plant.fmu.time_limit: found"));
  CHECK_THAT(refused("{name = \"k2\", value = 3.29}", "{name = \"k2\"}"),
             Contains("plant.fmu.parameter[13].value: found nothing"));
}

}  // namespace
}  // namespace mpm
