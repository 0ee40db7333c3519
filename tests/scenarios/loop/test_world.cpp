#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/loop/world.hpp"
#include "scenarios/study/study_controller.hpp"
#include "tests/scenarios/study_texts.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// The small study with a table [world].
Study world_study(const std::string& keys) {
  return parse_study(testing::small_study() + "\n[world]\n" + keys, "s.toml");
}

double lag_one(const Eigen::RowVectorXd& x) {
  return x.head(x.size() - 1).dot(x.tail(x.size() - 1)) / x.squaredNorm();
}

}  // namespace

TEST_CASE("world: a study without the table, and the exact world, have no errors and no background",
          "[world]") {
  const Study exact = parse_study(testing::small_study(), "s.toml");
  CHECK_FALSE(exact.world);
  CHECK(world_of(exact, 3) == kExactWorld);
  const Study study =
      world_study("gain_factor = {uniform = [0.9, 1.1]}\nbackground.cv_size = {constant = 1}\n");
  const World world = draw_world(study, kExactWorld);
  CHECK(world.errors.empty());
  CHECK(background(study, world, 0).y_d.size() == 0);
  const Trajectory nominal = simulate_experiment(study, basis_draw(), testing::kFactory);
  CHECK(nominal.y == simulate_experiment(exact, basis_draw(), testing::kFactory).y);
}

TEST_CASE("world: one without errors and background gives the loops of a study without worlds, bit for bit",
          "[world]") {
  for (const char* const name : {"chapter6", "wood-berry", "suite-tank"}) {
    Study study = find_study(name);
    study.simulation.samples = std::min(study.simulation.samples, 150);
    Study worlds = study;
    worlds.world = WorldRanges{.count = 2};
    for (std::int64_t index = 0; index < 4; ++index) {
      INFO(name << ", experiment " << index);
      const Trajectory alone = simulate_experiment(study, draw_experiment(study, index), testing::kFactory);
      const Trajectory in_world =
          simulate_experiment(worlds, draw_experiment(worlds, index), testing::kFactory);
      CHECK((alone.y == in_world.y && alone.u == in_world.u && alone.d == in_world.d));
    }
  }
}

TEST_CASE("world: every channel has errors of its own within their distributions, the same in every loop",
          "[world]") {
  const Study study = world_study(
      "count = 3\ngain_factor = {uniform = [0.9, 1.1]}\ntime_constant_factor = {uniform = [0.8, 1.2]}\n"
      "dead_time_factor = {uniform = [0.5, 1.5]}\nextra_lag = {uniform = [0.01, 0.02]}\n");
  int channels = 0;
  for (Eigen::Index cv = 0; cv < study.plant.G.rows(); ++cv)
    for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input)
      channels += study.plant.G(cv, input).is_zero() ? 0 : 1;
  for (int number = 0; number < 3; ++number) {
    const World world = draw_world(study, number);
    std::map<MismatchParameter, int> found;
    for (const Mismatch& error : world.errors) {
      ++found[error.parameter];
      if (error.parameter == MismatchParameter::gain)
        CHECK(std::abs(error.value - 1.0) <= 0.1);
      if (error.parameter == MismatchParameter::dead_time)
        CHECK(std::abs(error.value) <= 0.5 * study.plant.G(error.cv, error.input).dead_time());
    }
    CHECK(found[MismatchParameter::gain] == channels);
    CHECK(found[MismatchParameter::time_constant] == channels);
    CHECK(found[MismatchParameter::second_order] == channels);
    CHECK(draw_world(study, number).errors == world.errors);
    CHECK_FALSE(draw_world(study, number + 1).errors == world.errors);
  }
}

TEST_CASE("world: experiments of each kind go to the worlds in turn", "[world]") {
  Study study = world_study("count = 3\n");
  study.experiments = {.mpm = 7, .ud = 5, .healthy = 9};
  std::map<std::pair<ExperimentKind, int>, int> counts;
  for (std::int64_t index = 0; index < 21 * 4; ++index) {
    const ExperimentDraw draw = draw_experiment(study, index);
    REQUIRE(draw.world == world_of(study, index));
    ++counts[{draw.kind, draw.world}];
  }
  for (const auto& [kind, of_kind] :
       {std::pair(ExperimentKind::mpm, 28), {ExperimentKind::ud, 20}, {ExperimentKind::healthy, 36}})
    for (int world = 0; world < 3; ++world)
      CHECK(std::abs(counts[std::pair(kind, world)] - of_kind / 3.0) < 1.0);
}

TEST_CASE("world: without noise the simulation error is the error of the gain times the channel", "[world]") {
  // Setpoints from 0: the loop begins at rest with all inputs 0, and is linear.
  Study study = find_study("suite-ogunnaike-ray");
  study.simulation.noise_standard_deviation.setZero();
  study.world = WorldRanges{.count = 1, .gain_factor = Distribution::constant(1.05)};
  const Trajectory loop = simulate_experiment(study, basis_draw(0), testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  Eigen::MatrixXd input(loop.u.rows() + loop.d.rows(), loop.u.cols());
  input << loop.u, loop.d;
  const Eigen::MatrixXd y_sim = simulate(study.plant.G, study.controller.sample_time, input);
  // y = 1.05 G0 u: the error of the simulation is 0.05 y_sim, up to the rounding of 400 samples.
  CHECK((loop.y - y_sim - 0.05 * y_sim).cwiseAbs().maxCoeff() < 1e-10 * y_sim.cwiseAbs().maxCoeff());
  CHECK(y_sim.cwiseAbs().maxCoeff() > 0.1);
}

TEST_CASE("world: a mismatch multiplies what the world has, and dead times stay above 0", "[world]") {
  const Study study = world_study("count = 2\ngain_factor = {uniform = [0.9, 1.1]}\n");
  const TransferMatrix healthy = world_plant(study, draw_world(study, 1));
  const TransferMatrix faulty = with_world_mismatches(
      healthy, {{0, 0, MismatchParameter::gain, 2.0}, {0, 0, MismatchParameter::dead_time, -1e6}});
  CHECK(faulty(0, 0).static_gain() == Approx(2.0 * healthy(0, 0).static_gain()));
  CHECK(faulty(0, 0).dead_time() == 0.0);
  CHECK(faulty(1, 1) == healthy(1, 1));
}

TEST_CASE("world: the background has the size and the colour of its world, and other values in each loop",
          "[world]") {
  Study study = world_study(
      "count = 1\n[world.background]\ncv_size = {constant = 2}\ntime_constant = {constant = 10}\n");
  study.simulation.samples = 200000;
  const World world = draw_world(study, 0);
  const Eigen::MatrixXd y_d = background(study, world, 5).y_d;
  REQUIRE(y_d.rows() == study.cv_count());
  const double pole = std::exp(-1.0 / 10.0);
  for (Eigen::Index cv = 0; cv < y_d.rows(); ++cv) {
    // 200000 samples have the information of 200000 (1 - a) / (1 + a) independent ones.
    const double size = 2.0 * study.simulation.noise_standard_deviation(cv);
    CHECK(std::sqrt(y_d.row(cv).squaredNorm() / 200000) == Approx(size).epsilon(0.03));
    CHECK(lag_one(y_d.row(cv)) == Approx(pole).margin(0.01));
  }
  CHECK(background(study, world, 6).y_d != y_d);
  CHECK(background(study, world, 5).u_d.size() == 0);
}

TEST_CASE("world: the nonlinear tank and its mismatches start from the parameters of the world", "[world]") {
  const std::string text = testing::project_file("scenarios/studies/suite-tank.toml");
  const Study exact = parse_study(text, "tank.toml");
  REQUIRE(exact.nonlinear);
  const std::string name = exact.mismatch.plant_parameters.front().name;
  const Study study = parse_study(text + "\n[world]\ncount = 2\nplant_parameter = [{name = \"" + name +
                                      "\", factor = {uniform = [0.95, 1.05]}}]\n",
                                  "tank.toml");
  const World world = draw_world(study, 1);
  REQUIRE(world.parameters.size() == 1);
  const double nominal = world.parameters[0].value;
  const auto changed = with_world_parameters(study, world, {{name, 3.0}});
  double of_study = 0.0;
  for (const auto& parameter : study.nonlinear->model.parameters)
    if (parameter.name == name)
      of_study = parameter.nominal;
  CHECK(nominal != of_study);
  CHECK(changed[0].value == Approx(3.0 * nominal / of_study));
  const Trajectory loop = simulate_experiment(study, basis_draw(1), testing::kFactory);
  CHECK(loop.status == ControlStatus::ok);
  CHECK(loop.y != simulate_experiment(exact, basis_draw(), testing::kFactory).y);
}

TEST_CASE("world: what cannot be one is refused", "[world]") {
  const auto refused = [](const std::string& keys) {
    return testing::refusal(testing::small_study() + "\n[world]\n" + keys);
  };
  CHECK_THAT(refused("count = 0\n"), Catch::Contains("world.count") && Catch::Contains("1 to 10000"));
  CHECK_THAT(refused("gain_factor = {uniform = [-1, 1]}\n"), Catch::Contains("world.gain_factor"));
  CHECK_THAT(refused("plant_parameter = [{name = \"a\", factor = {constant = 1}}]\n"),
             Catch::Contains("world.plant_parameter"));
  CHECK_THAT(refused("gain = {constant = 1}\n"), Catch::Contains("gain_factor"));
}

TEST_CASE("excitation: each loop has steps of its own, listed and in their ranges, and no other differences",
          "[world]") {
  Study study = find_study("suite-ogunnaike-ray");
  study.simulation.excitation = SignalSequence::each;
  const Study first = with_excitation(study, 0), again = with_excitation(study, 0),
              second = with_excitation(study, 1);
  CHECK(setpoints(with_excitation(study, kBasisIndex)) == setpoints(study));
  CHECK(first.simulation.excitation == SignalSequence::shared);
  CHECK(first == again);
  CHECK(setpoints(first) != setpoints(second));
  CHECK(setpoints(first).rows() == study.cv_count());
  const double largest = setpoints(find_study("suite-ogunnaike-ray")).cwiseAbs().maxCoeff();
  CHECK(setpoints(first).cwiseAbs().maxCoeff() <= largest);
  CHECK(measurement_noise(first, 0) == measurement_noise(study, 0));
  // simulate_experiment() does it by itself.
  const ExperimentDraw draw = draw_experiment(study, 1);
  CHECK(simulate_experiment(study, draw, testing::kFactory).y ==
        simulate_experiment(second, draw, testing::kFactory).y);
}

TEST_CASE("world: a background that swells has the same numbers, at another size along the record",
          "[world]") {
  const std::string size = "background = {cv_size = {constant = 1}";
  const Study steady = world_study(size + "}\n");
  const Study swells = world_study(size + ", swell = {constant = 9}}\n");
  const World world = draw_world(swells, 0);
  CHECK(world.background_swell == 9.0);
  const Eigen::MatrixXd a = background(steady, draw_world(steady, 0), 3).y_d;
  const Eigen::MatrixXd b = background(swells, world, 3).y_d;
  const Eigen::ArrayXXd ratio = b.array() / a.array();
  CHECK((ratio.row(0) - ratio.row(1)).abs().maxCoeff() < 1e-9);
  CHECK(ratio.maxCoeff() == Approx(3.0).epsilon(0.01));
  CHECK(ratio.minCoeff() == Approx(1.0 / 3.0).epsilon(0.01));
  CHECK(background(swells, world, 4).y_d.cwiseQuotient(background(steady, draw_world(steady, 0), 4).y_d) !=
        b.cwiseQuotient(a));  // at another time
}

TEST_CASE("world: a valve with a characteristic gives the plant another gain, and rests where it did",
          "[world]") {
  Study study = find_study("wood-berry");
  study.simulation.noise_standard_deviation.setZero();
  study.world = WorldRanges{.count = 1, .valve_curvature = Distribution::constant(0.5)};
  const ExperimentDraw draw = basis_draw(0);
  const LoopSignals signals = experiment_signals(study, draw);
  CHECK((signals.valve_curvature.array() == 0.5).all());
  const Trajectory bent = simulate_experiment(study, draw, testing::kFactory);
  REQUIRE(bent.status == ControlStatus::ok);
  const std::unique_ptr<Controller> controller = controller_of(study, study.controller, testing::kFactory);
  const Eigen::VectorXd rest = controller->nominal_target(Eigen::VectorXd::Zero(study.md_count()));
  // The plant had f(u) of what the record shows.
  const Limits& hard = study.controller.mv_hard;
  Eigen::MatrixXd inputs(bent.u.rows() + bent.d.rows(), bent.u.cols());
  inputs << bent.u, bent.d;
  for (Eigen::Index mv = 0; mv < bent.u.rows(); ++mv) {
    const double a = hard.lower(mv), b = hard.upper(mv);
    const auto added = [&](double u) { return 0.5 * (u - a) * (b - u) / (b - a); };
    for (Eigen::Index k = 0; k < bent.u.cols(); ++k)
      inputs(mv, k) += added(bent.u(mv, k)) - added(rest(mv));
  }
  LinearPlant plant(study.plant.G, study.controller.sample_time);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(inputs.rows());
  start.head(rest.size()) = rest;
  plant.reset(start);
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    CHECK((plant.output() - bent.y.col(k)).cwiseAbs().maxCoeff() < 1e-9);
    plant.advance(inputs.col(k));
  }
}

}  // namespace mpm
