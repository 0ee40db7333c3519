#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/nonlinear/foreign_plant.hpp"
#include "plants/nonlinear/nonlinear_plant.hpp"
#include "plants/outside/program_model.hpp"

// The program tests/plants/first_order.py against the transfer functions that it computes.

namespace mpm {
namespace {

using Catch::Contains;

constexpr double kSampleTime = 4.0;

NonlinearModel program_plant(double wrong = 0.0, std::vector<std::string> command = {MPMBENCH_PYTHON3, "-B",
                                                                                     MPMBENCH_FIRST_ORDER}) {
  NonlinearModel model;
  model.parameters = {{"gain", 2.0}, {"wrong", wrong}};
  model.inner_inputs = {"inner"};
  model.operating_input = Eigen::Vector3d(5.0, 1.0, 0.0);
  ProgramSettings settings;
  settings.command = std::move(command);
  settings.parameters = {"gain", "wrong"};
  settings.mvs = settings.mds = settings.inner = settings.outputs = 1;
  // Rest is reached when e^(-settle/50) is below the tolerance by far.
  model.foreign = program_model(settings, {.settle = 1600.0, .time_limit = 30.0});
  return model;
}

TEST_CASE("a program is the plant that it computes", "[program-plant]") {
  const TransferMatrix G{
      {TransferFunction::first_order(2.0, 30.0), TransferFunction::first_order(2.0, 50.0)}};
  LinearPlant expected(G, kSampleTime);
  const auto plant = nonlinear_plant(program_plant(), kSampleTime, {}, {});
  expected.reset(Eigen::Vector2d(0.3, 0.0));
  plant->reset(Eigen::Vector3d(0.3, 0.0, 0.0));
  for (int k = 0; k < 30; ++k) {
    // e^(-1600/50) of the 10 of the operating point is 1e-13; the rest is rounding.
    CHECK(plant->output()(0) == Approx(expected.output()(0)).margin(1e-10));
    const Eigen::Vector2d input(k < 10 ? 1.0 : -0.5, k < 20 ? 0.0 : 2.0);
    expected.advance(input);
    REQUIRE(plant->advance(Eigen::Vector3d(input(0), input(1), 0.0)) == PlantStatus::ok);
  }
  const double before = plant->output()(0);
  REQUIRE(plant->advance(Eigen::Vector3d(-0.5, 2.0, 7.0)) == PlantStatus::ok);
  CHECK(plant->output()(0) > before + 6.0);  // the inner input
}

TEST_CASE("parameters of a program come with its reset", "[program-plant]") {
  const auto plant = nonlinear_plant(program_plant(), kSampleTime, {}, {{"gain", 3.0}});
  plant->reset(Eigen::Vector3d::Zero());
  CHECK(plant->output()(0) ==
        Approx(6.0).margin(1e-10));  // (3 - 2)(5 + 1): it rests where the changed one does
  CHECK_THROWS_WITH(nonlinear_plant(program_plant(), kSampleTime, {}, {{"gain", 3.0}}, 5),
                    Contains("found sample 5 for 'gain', which is fixed"));
}

TEST_CASE("a program that answers wrongly fails its loop, and says how", "[program-plant]") {
  const auto failure = [](double wrong, const std::vector<std::string>& command = {MPMBENCH_PYTHON3, "-B",
                                                                                   MPMBENCH_FIRST_ORDER}) {
    const auto plant = nonlinear_plant(program_plant(wrong, command), kSampleTime, {}, {});
    try {
      plant->reset(Eigen::Vector3d::Zero());
    } catch (const NoSteadyState& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(failure(0) == "accepted");
  CHECK_THAT(failure(1), Contains("out of ideas"));
  CHECK_THAT(failure(2), Contains("it says: \"dry\""));
  CHECK_THAT(failure(3), Contains("without \"y\" of 1 numbers: {\"y\":[1.0,2.0]}"));
  CHECK_THAT(failure(4), Contains("not a JSON object: [1.0]"));
  CHECK_THAT(failure(5), Contains("without \"y\" of 1 numbers"));
  CHECK_THAT(failure(6), Contains("not a JSON object: never mind"));
  CHECK_THAT(failure(0, {"mpmbench-no-such-program"}), Contains("mpmbench-no-such-program"));
}

}  // namespace
}  // namespace mpm
