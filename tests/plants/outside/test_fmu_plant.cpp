#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.hpp"
#include "plants/nonlinear/foreign_plant.hpp"
#include "plants/nonlinear/nonlinear_plant.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"
#include "plants/outside/fmu_instance.hpp"
#include "plants/outside/fmu_model.hpp"

// The tank of tests/plants/fmu/tank.c against the one that the program has.

namespace mpm {
namespace {

using Catch::Contains;
namespace fs = std::filesystem;

constexpr double kSampleTime = 10.0;
constexpr double kSettle = 5000.0;  // both tanks then rest to the last bits
// Of our integration in these tests, relative; by default it errs by some 1e-9 cm (docs/plants.md).
constexpr double kLocalError = 1e-12;
// Errors of thousands of steps of ours add up to some 1e-10 cm; those of the FMU are below 1e-10 cm.
constexpr double kTolerance = 1e-8;

FmuSettings tank_settings() {
  FmuSettings settings{
      .file = MPMBENCH_TANK_FMU, .place = "file", .inputs = {}, .outputs = {}, .parameters = {}};
  for (const char* name : {"v1", "v2", "x1", "x2", "F1", "F2", "F3", "F4", "D1", "D2", "D3", "D4"})
    settings.inputs.push_back({name, "input"});
  for (int i = 1; i <= 4; ++i)
    settings.outputs.push_back({fmt::format("level[{}]", i), "output"});
  return settings;
}

/// The nonlinear tank of the catalogue with another simulation, whose parameters are those of ours and two
/// more.
NonlinearModel fmu_tank(FmuSettings settings = tank_settings(),
                        ForeignOptions options = {.settle = kSettle}) {
  NonlinearModel model = quadruple_tank_nonlinear("table-2.6", 0);
  model.make_system = nullptr;
  model.parameters.push_back({"offset", 0.0});
  model.parameters.push_back({"failure", 0.0});
  for (const NonlinearModel::Parameter& parameter : model.parameters)
    settings.parameters.push_back({parameter.name, "parameter"});
  model.foreign = fmu_model(std::move(settings), options);
  return model;
}

std::unique_ptr<Plant> plant_of(const NonlinearModel& model, const std::vector<ParameterChange>& changes = {},
                                Eigen::Index onset = 0) {
  return nonlinear_plant(model, kSampleTime,
                         {.relative_tolerance = kLocalError, .absolute_tolerance = kLocalError}, changes,
                         onset);
}

/// Largest difference of two plants over steps of all inputs.
double difference(Plant& one, Plant& other, const Eigen::VectorXd& rest) {
  one.reset(rest);
  other.reset(rest);
  double largest = (one.output() - other.output()).cwiseAbs().maxCoeff();
  Eigen::VectorXd input = rest;
  for (Eigen::Index k = 0; k < 60; ++k) {
    if (k % 5 == 0) {
      const Eigen::Index i = (k / 5) % 12;
      input(i) += i < 4 ? 0.05 : 0.2;
    }
    REQUIRE(one.advance(input) == PlantStatus::ok);
    REQUIRE(other.advance(input) == PlantStatus::ok);
    largest = std::max(largest, (one.output() - other.output()).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST_CASE("the FMU of the tank is the tank, at rest and under inputs", "[fmu]") {
  const NonlinearModel ours = quadruple_tank_nonlinear("table-2.6", 0), theirs = fmu_tank();
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(12);
  CHECK(difference(*plant_of(ours), *plant_of(theirs), rest) < kTolerance);
  rest(0) = 0.3;
  rest(3) = -0.05;
  CHECK(difference(*plant_of(ours), *plant_of(theirs), rest) < kTolerance);
}

TEST_CASE("tunable parameters of an FMU change at the onset, as those of the tank do", "[fmu]") {
  const NonlinearModel ours = quadruple_tank_nonlinear("table-2.6", 0), theirs = fmu_tank();
  const std::vector<ParameterChange> changes{{"cd1", 3.9}, {"k2", 3.0}};
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(12);
  for (const Eigen::Index onset : {0, 17}) {
    const auto one = plant_of(ours, changes, onset), other = plant_of(theirs, changes, onset);
    CHECK(difference(*one, *other, rest) < kTolerance);
    CHECK(difference(*plant_of(ours), *other, rest) > 0.1);
  }
}

TEST_CASE("a fixed parameter of an FMU has its changed value from the start", "[fmu]") {
  const auto plant = plant_of(fmu_tank(), {{"A1", 40.0}});
  plant->reset(Eigen::VectorXd::Zero(12));
  CHECK(plant->output().cwiseAbs().maxCoeff() < kTolerance);  // the area moves no steady state
  CHECK(difference(*plant, *plant_of(fmu_tank()), Eigen::VectorXd::Zero(12)) > 0.05);
  CHECK_THROWS_WITH(plant_of(fmu_tank(), {{"A1", 40.0}}, 3),
                    Contains("found sample 3 for 'A1', which is fixed; allowed: 0"));
}

TEST_CASE("outputs are deviations from the operating point of the nominal parameters", "[fmu]") {
  const auto plant = plant_of(fmu_tank(), {{"offset", 2.0}});
  plant->reset(Eigen::VectorXd::Zero(12));
  CHECK(plant->output().cwiseAbs().maxCoeff() < kTolerance);
  REQUIRE(plant->advance(Eigen::VectorXd::Zero(12)) == PlantStatus::ok);
  CHECK((plant->output().array() - 2.0).abs().maxCoeff() < kTolerance);
}

TEST_CASE("what an FMU did before leaves no trace", "[fmu]") {
  const NonlinearModel model = fmu_tank();
  const auto plant = plant_of(model);
  const auto run = [&] {
    plant->reset(Eigen::VectorXd::Zero(12));
    REQUIRE(plant->advance(Eigen::VectorXd::Constant(12, 0.1)) == PlantStatus::ok);
    return plant->output();
  };
  const Eigen::VectorXd first = run();
  const auto crashing = plant_of(model, {{"failure", 1.0}});
  crashing->reset(Eigen::VectorXd::Zero(12));
  CHECK(crashing->advance(Eigen::VectorXd::Zero(12)) == PlantStatus::failed);
  CHECK(run() == first);  // to the bit; the FMU allows one instance a process
}

TEST_CASE("an FMU that fails fails its loop, and says how", "[fmu]") {
  ForeignOptions options{.settle = kSettle};
  const auto failure = [&](double way) {
    const auto plant = plant_of(fmu_tank(tank_settings(), options), {{"failure", way}});
    plant->reset(Eigen::VectorXd::Zero(12));
    CHECK(plant->advance(Eigen::VectorXd::Zero(12)) == PlantStatus::failed);
    return plant->failure();
  };
  CHECK_THAT(failure(1), Contains("its process ended by signal 11 (Segmentation fault)"));
  CHECK(failure(2) ==
        "the simulation of the plant failed: fmi2DoStep at its time 5000: error (it says: tank 3 is empty)");
  CHECK_THAT(failure(3), Contains("fatal error"));
  CHECK_THAT(failure(5), Contains("ended with code 3"));
  CHECK_THAT(failure(6), Contains("an output that is not finite at its time 5010"));
  CHECK_THAT(failure(7), Contains("discard"));
  options.time_limit = 0.5;
  CHECK_THAT(failure(4), Contains("no answer within 0.5 s"));
}

TEST_CASE("an FMU by FMI 3.0 is the one by FMI 2.0, to the bit, and fails as it does", "[fmu]") {
  FmuSettings settings = tank_settings();
  settings.file = MPMBENCH_TANK3_FMU;
  const std::vector<ParameterChange> changes{{"cd1", 3.9}, {"A1", 30.0}};
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(12);
  CHECK(difference(*plant_of(fmu_tank(), changes), *plant_of(fmu_tank(settings), changes), rest) == 0.0);
  const auto failure = [&](double way) {
    const auto plant = plant_of(fmu_tank(settings), {{"failure", way}});
    plant->reset(rest);
    CHECK(plant->advance(rest) == PlantStatus::failed);
    return plant->failure();
  };
  CHECK(failure(2) ==
        "the simulation of the plant failed: fmi3DoStep at its time 5000: error (it says: tank 3 is empty)");
  CHECK_THAT(failure(6), Contains("an output that is not finite at its time 5010"));
  CHECK_THAT(failure(20), Contains("fmi3DoStep at its time 5000: it asks to end"));
  CHECK_THAT(failure(21), Contains("it returned early, at 5000, which was not allowed"));
  settings.outputs[0] = {"profile", "s.toml:7: plant.fmu.output[0].variable"};
  CHECK_THROWS_WITH(fmu_tank(settings).foreign->load(),
                    Contains("output[0].variable: found 'profile' of type Float64 array; allowed: level[1]"));
}

TEST_CASE("an FMU for model exchange is the tank, integrated here", "[fmu]") {
  FmuSettings settings = tank_settings();
  settings.file = MPMBENCH_TANK_ME_FMU;
  const NonlinearModel ours = quadruple_tank_nonlinear("table-2.6", 0);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(12);
  constexpr double kOfIntegration = 1e-6;  // cm: local errors of 1e-8 of hundreds of steps
  CHECK(difference(*plant_of(ours), *plant_of(fmu_tank(settings)), rest) < kOfIntegration);
  const std::vector<ParameterChange> changes{{"cd1", 3.9}, {"k2", 3.0}};
  CHECK(difference(*plant_of(ours, changes, 17), *plant_of(fmu_tank(settings), changes, 17), rest) <
        kOfIntegration);
  const auto failure = [&](double way) {
    const auto plant = plant_of(fmu_tank(settings), {{"failure", way}});
    plant->reset(rest);
    CHECK(plant->advance(rest) == PlantStatus::failed);
    return plant->failure();
  };
  CHECK_THAT(failure(1), Contains("its process ended by signal 11 (Segmentation fault)"));
  CHECK_THAT(failure(2),
             Contains("fmi2GetDerivatives at its time 5") && Contains("it says: tank 3 is empty"));
  CHECK_THAT(failure(20), Contains("fmi2NewDiscreteStates at its time 5000: it asks to end"));
}

TEST_CASE("events of an FMU for model exchange: roots, times and requests, against the closed form",
          "[fmu]") {
  const FmuPackage package(MPMBENCH_SWITCH3_FMU);
  CHECK(package.description().kind == FmuKind::model_exchange);
  const FmuReferences references{.inputs = {1}, .outputs = {2}, .parameters = {}};
  FmuInstance fmu(package, references, Eigen::VectorXd(), Eigen::VectorXd::Constant(1, 2.0), {1.0, 1});
  const double passes = 4.0 * std::log(2.0);  // x = 2 (1 - exp(-t/4)) = 1
  double last = 0.0;
  for (int k = 1; k <= 12; ++k) {
    // From the time 10 on the input is 3.
    last = fmu.step(Eigen::VectorXd::Constant(1, k <= 10 ? 2.0 : 3.0))(0);
    const double t = k, x10 = 2.0 - std::exp(-(10.0 - passes) / 8.0);
    const double x = t < passes  ? 2.0 - 2.0 * std::exp(-t / 4.0)
                     : t <= 10.0 ? 2.0 - std::exp(-(t - passes) / 8.0)
                                 : 3.0 + (x10 - 3.0) * std::exp(-(t - 10.0) / 8.0);
    CHECK(last == Approx(x + (t < 5 ? 0.0 : t <= 8 ? 10.0 : 20.0)).margin(1e-7));
  }
}

TEST_CASE("an FMU that does not come to rest has no steady state", "[fmu]") {
  const auto short_of = plant_of(fmu_tank(tank_settings(), {.settle = 200.0}));
  CHECK_THROWS_AS(short_of->reset(Eigen::VectorXd::Zero(12)), NoSteadyState);
  CHECK_THROWS_WITH(short_of->reset(Eigen::VectorXd::Zero(12)),
                    Contains("in the last tenth of plant settle"));
  NonlinearModel broken = fmu_tank();
  broken.parameters.back().nominal = 1.0;  // fails from the start
  const auto plant = plant_of(broken);
  CHECK_THROWS_AS(plant->reset(Eigen::VectorXd::Zero(12)), NoSteadyState);
}

/// The lag of tests/plants/fmu/own_names.c.
std::unique_ptr<Plant> own_lag(double step, double failure = 0.0) {
  FmuSettings settings{.file = MPMBENCH_OWN_FMU,
                       .place = "file",
                       .step = step,
                       .inputs = {{"u", "input"}},
                       .outputs = {{"y", "output"}},
                       .parameters = {{"failure", "parameter"}}};
  NonlinearModel model;
  model.operating_input = Eigen::VectorXd::Zero(1);
  model.parameters = {{"failure", 0.0}};
  model.foreign = fmu_model(std::move(settings), {.settle = 50.0});
  return plant_of(model, failure == 0.0 ? std::vector<ParameterChange>()
                                        : std::vector<ParameterChange>{{"failure", failure}});
}

TEST_CASE("an FMU calls its own functions, whatever names this program has, and is told what it needs",
          "[fmu]") {
  const auto plant = own_lag(2.0);
  plant->reset(Eigen::VectorXd::Zero(1));
  for (int k = 1; k <= 3; ++k) {  // beyond the 10 s of its own experiment
    REQUIRE(plant->advance(Eigen::VectorXd::Ones(1)) == PlantStatus::ok);
    CHECK(plant->output()(0) == Approx(1.0 - std::exp(-k * kSampleTime / 10.0)).epsilon(1e-12));
  }
  const auto long_steps = own_lag(0.0);
  CHECK_THROWS_AS(long_steps->reset(Eigen::VectorXd::Zero(1)), NoSteadyState);
  const auto failing = own_lag(2.0, 1.0);
  failing->reset(Eigen::VectorXd::Zero(1));
  CHECK(failing->advance(Eigen::VectorXd::Zero(1)) == PlantStatus::failed);
  CHECK_THAT(failing->failure(), Contains("(it says: no water in the lag)"));
}

TEST_CASE("files that are no FMU are refused, and nothing is left of them", "[fmu]") {
  const fs::path folder = fs::temp_directory_path() / fmt::format("mpmbench-test-fmu-{}", ::getpid());
  fs::create_directories(folder);
  ::setenv("TMPDIR", folder.c_str(), 1);
  const auto refusal = [&](const fs::path& file) -> std::string {
    FmuSettings settings = tank_settings();
    settings.file = file;
    try {
      fmu_tank(settings).foreign->load();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK_THAT(refusal(folder / "none.fmu"), Contains("none.fmu', which is no file"));
  std::ofstream(folder / "text.fmu") << "no ZIP at all";
  CHECK_THAT(refusal(folder / "text.fmu"), Contains("text.fmu' (Not a zip archive); allowed: an FMU"));
  FmuSettings settings = tank_settings();
  settings.inputs[1] = {"pump2", "s.toml:9: plant.fmu.input[1].variable"};
  CHECK_THROWS_WITH(fmu_tank(settings).foreign->load(),
                    Contains("s.toml:9: plant.fmu.input[1].variable: found 'pump2', which ") &&
                        Contains("allowed: D1, D2, D3, D4, F1"));
  {
    const NonlinearModel model = fmu_tank();
    const auto plant = plant_of(model);
    CHECK(std::distance(fs::directory_iterator(folder), {}) == 2);  // text.fmu, and the unpacked FMU
  }
  CHECK(std::distance(fs::directory_iterator(folder), {}) == 1);
  ::unsetenv("TMPDIR");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace mpm
