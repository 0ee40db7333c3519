#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/fault_cost.hpp"
#include "analysis/experiment/repair_gain.hpp"
#include "analysis/experiment/repaired_model.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What the repair of a channel would bring, in worlds in which it is known.

namespace mpm {
namespace {

constexpr int kRepairLoops = 4;

/// ogunnaike-ray in a world without errors.
Study exact_world() {
  Study study = find_study("suite-ogunnaike-ray");
  study.simulation.samples = 200;
  study.world = WorldRanges{.count = 1};
  return study;
}

ExperimentDraw fault_of_gain(const Study& study, double factor) {
  ExperimentDraw draw;
  draw.index = 4;
  draw.world = study.world ? 0 : kExactWorld;
  draw.kind = ExperimentKind::mpm;
  draw.mismatches = {{1, 0, MismatchParameter::gain, factor}};
  return draw;
}

/// Mean cost of the loops of `study` with the noise of the repairs.
double mean_cost(const Study& study, const Study& of_noise, const ExperimentDraw& draw) {
  double sum = 0.0;
  for (int loop = 0; loop < kRepairLoops; ++loop) {
    ExperimentDraw noisy = draw;
    noisy.noise_index = pilot_noise(of_noise, draw, kRepairLoops, loop);
    const Trajectory run = simulate_experiment(study, noisy, testing::kFactory);
    REQUIRE(run.status == ControlStatus::ok);
    sum += loop_cost(study, run).total();
  }
  return sum / kRepairLoops;
}

}  // namespace

TEST_CASE(
    "repair gain: in an exact world the repair of the mismatched channel gives the loop of a controller "
    "that was designed for this plant, and the repair of another channel gives nothing",
    "[repair_gain]") {
  const Study study = exact_world();
  const ExperimentDraw draw = fault_of_gain(study, 0.4);
  SolverStatistics pilots;
  const RepairGains gains = repair_gains(study, draw, kRepairLoops, testing::kFactory, pilots);
  CHECK(pilots.steps ==
        3 * kRepairLoops * study.simulation.samples);  // as it is, without the fault, one repair
  Study designed = study;  // an independent route: its model is the plant, and nothing is wrong
  designed.plant.G = true_plant(study, draw);
  const double without = mean_cost(study, study, draw.without_faults());
  const double now = mean_cost(study, study, draw);
  const double repaired = mean_cost(designed, study, draw.without_faults());
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
      if (cv == 1 && mv == 0)
        CHECK(gains.gain(cv, mv) == Approx((now - repaired) / without).epsilon(1e-9));
      else
        CHECK((gains.gain(cv, mv) == 0.0 && gains.error(cv, mv) == 0.0));
  REQUIRE(gains.best());
  CHECK(*gains.best() == gains.gain(1, 0));
  CHECK(gains.share_of(Channel{1, 0}) == 1.0);
  CHECK(gains.share_of(Channel{0, 0}) == 0.0);
  CHECK(gains.share_of({}) == 0.0);
  // The same noise as that of the cost of the fault.
  PilotCosts costs;
  const FaultCost cost = fault_cost(study, draw, kRepairLoops, testing::kFactory, pilots, &costs);
  CHECK(cost.loss_ratio == Approx(now / without).epsilon(1e-12));
  // Its loops are not run again.
  pilots = {};
  const RepairGains known = repair_gains(study, draw, kRepairLoops, testing::kFactory, pilots, costs);
  CHECK(pilots.steps == kRepairLoops * study.simulation.samples);
  CHECK(known.gain == gains.gain);
  CHECK((known.error.array() == gains.error.array() || gains.error.array().isNaN()).all());
  ExperimentDraw later = draw;  // the repair asks for the fault from the first sample on
  later.onset = {.sample = 50};
  fault_cost(study, later, kRepairLoops, testing::kFactory, pilots, &costs);
  pilots = {};
  CHECK(repair_gains(study, later, kRepairLoops, testing::kFactory, pilots, costs).gain == gains.gain);
  CHECK(pilots.steps == 2 * kRepairLoops * study.simulation.samples);
}

TEST_CASE("repair gain: channels that bring little in the first loop are screened out", "[repair_gain]") {
  Study study = exact_world();
  ExperimentDraw draw = fault_of_gain(study, 0.4);
  draw.mismatches.push_back({0, 1, MismatchParameter::gain, 1.02});  // next to nothing
  draw.mismatches.push_back({2, 2, MismatchParameter::gain, 0.5});
  SolverStatistics whole, screened;
  const RepairGains all = repair_gains(study, draw, kRepairLoops, testing::kFactory, whole);
  REQUIRE(all.gain(0, 1) < 0.5 * all.gain(1, 0));
  study.world->repair_screen = 0.5;
  const RepairGains some = repair_gains(study, draw, kRepairLoops, testing::kFactory, screened);
  CHECK(some.gain(1, 0) == all.gain(1, 0));
  CHECK(some.error(1, 0) == all.error(1, 0));
  CHECK(some.best() == all.best());
  CHECK(std::isnan(some.error(0, 1)));
  CHECK(std::abs(some.gain(0, 1) - all.gain(0, 1)) < 0.05);
  CHECK(whole.steps == 5 * kRepairLoops * study.simulation.samples);
  const bool second_stays = !std::isnan(some.error(2, 2));
  CHECK(screened.steps ==
        whole.steps - (second_stays ? 1 : 2) * (kRepairLoops - 1) * study.simulation.samples);
}

TEST_CASE("repair gain: that of a measured disturbance is that of the feed-forward that knows it",
          "[repair_gain]") {
  const Study study = exact_world();
  const Eigen::Index md = study.mv_count();  // d1, which moves at sample 100
  ExperimentDraw draw = fault_of_gain(study, 1.0);
  draw.mismatches = {{2, md, MismatchParameter::gain, 3.0}};
  SolverStatistics pilots;
  const RepairGains gains = repair_gains(study, draw, kRepairLoops, testing::kFactory, pilots);
  Study designed = study;
  designed.plant.G = true_plant(study, draw);
  const double now = mean_cost(study, study, draw);
  const double repaired = mean_cost(designed, study, draw.without_faults());
  const double without = mean_cost(study, study, draw.without_faults());
  REQUIRE(gains.gain.cols() == study.mv_count() + study.md_count());
  CHECK(gains.gain(2, md) == Approx((now - repaired) / without).epsilon(1e-9));
  CHECK(gains.gain(2, md) > 0.01);
  CHECK((gains.gain.array() != 0.0).count() == 1);
  CHECK(*gains.best() == gains.gain(2, md));
}

TEST_CASE(
    "repair gain: with one channel and moves that cost next to nothing, the repair of its gain gives back "
    "the cost of the loop without the fault",
    "[repair_gain]") {
  // The controller makes up for a factor g of the gain by moves of 1/g, so that y is the same: in the limit
  // of no move suppression and without limits that are met, to the bit of the QP's tolerance.
  Study study = find_study("setpoint-methods");
  study.simulation.samples = 150;
  study.world = WorldRanges{.count = 1};
  study.controller.move_suppression.setConstant(1e-4);
  study.controller.mv_hard.lower.setConstant(-1e3);
  study.controller.mv_hard.upper.setConstant(1e3);
  ExperimentDraw draw = fault_of_gain(study, 1.0);
  draw.mismatches.clear();
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)  // the actuator: its repair is that of its channels
    draw.mismatches.push_back({cv, 0, MismatchParameter::gain, 0.7});
  const double without = mean_cost(study, study, draw.without_faults());
  double repaired = 0.0;
  for (int loop = 0; loop < kRepairLoops; ++loop) {
    ExperimentDraw noisy = draw;
    noisy.noise_index = pilot_noise(study, draw, kRepairLoops, loop);
    const Trajectory run = loop_with_model(study, true_plant(study, draw), noisy, testing::kFactory);
    repaired += loop_cost(study, run).total() / kRepairLoops;
  }
  CHECK(repaired == Approx(without).epsilon(1e-3));
  CHECK(mean_cost(study, study, draw) > 1.02 * without);
}

TEST_CASE(
    "repair gain: where every model is a little wrong each channel has one, of experiments with mismatches",
    "[repair_gain]") {
  Study study = find_study("wood-berry");
  study.simulation.samples = 150;
  study.world = WorldRanges{.count = 2, .gain_factor = Distribution::uniform(0.9, 1.1), .cost_loops = 2};
  study.experiments = {.mpm = 2, .ud = 2, .healthy = 2};
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"sse"}, testing::kFactory);
  for (std::int64_t index = 0; index < 6; ++index) {
    const ExperimentRecord record = runner.run(index, StorePolicy::none);
    REQUIRE(record.status == ExperimentStatus::ok);
    if (record.draw.kind != ExperimentKind::mpm) {
      CHECK(record.repair.gain.size() == 0);
      CHECK_FALSE(record.repair.best());
      continue;
    }
    REQUIRE(record.repair.gain.rows() == study.cv_count());
    REQUIRE(record.repair.gain.cols() == study.mv_count() + study.md_count());
    CHECK((record.repair.gain.array() != 0.0).all());
    CHECK((record.repair.error.array() > 0.0).all());
  }
  study.world->repair_loops = 0;
  ExperimentRunner without(study, basis, {"sse"}, testing::kFactory);
  CHECK(without.run(0, StorePolicy::none).repair.gain.size() == 0);
}

TEST_CASE("repair gain: the best is positive beyond chance, and no share is below 0 or of a loop that fails",
          "[repair_gain]") {
  RepairGains gains{(Eigen::Matrix2d() << 0.1, -0.3, kNaN, 0.4).finished(),
                    (Eigen::Matrix2d() << 0.01, 0.01, kNaN, 0.3).finished()};
  REQUIRE(gains.best());
  CHECK(*gains.best() == 0.1);  // 0.4 is chance
  CHECK(gains.share_of(Channel{1, 1}) == 1.0);
  CHECK(gains.share_of(Channel{0, 1}) == 0.0);
  CHECK(gains.share_of(Channel{1, 0}) == 0.0);
  gains.error(0, 0) = 0.06;
  CHECK_FALSE(gains.best());
  gains.error(0, 0) = kNaN;  // of a single loop
  CHECK_FALSE(gains.best());
}

}  // namespace mpm
