#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/sensitivity/loop_stability.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

// Experiments in worlds, whose plant is not the model, and with an excitation of their own.

namespace mpm {
namespace {

Study world_study() {
  Study study = find_study("wood-berry");
  study.simulation.samples = 150;
  study.world = WorldRanges{
      .count = 2,
      .gain_factor = Distribution::uniform(0.95, 1.05),
      .time_constant_factor = Distribution::uniform(0.95, 1.05),
      .background = {.cv_size = Distribution::constant(0.5), .time_constant = Distribution::constant(10.0)},
      .cost_loops = 2};
  study.experiments = {.mpm = 4, .ud = 4, .healthy = 4};
  return study;
}

std::int64_t first_of(const Study& study, ExperimentKind kind, int world) {
  std::int64_t index = 0;
  while (draw_experiment(study, index).kind != kind || draw_experiment(study, index).world != world)
    ++index;
  return index;
}

}  // namespace

TEST_CASE("worlds: an answer depends on the index only, whatever other worlds were met before", "[worlds]") {
  for (const SignalSequence excitation : {SignalSequence::shared, SignalSequence::each}) {
    Study study = world_study();
    study.simulation.excitation = excitation;
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    const std::vector<std::string> methods{"botelho", "counterfactual", "sse", "variance-ratio",
                                           "excitation"};
    ExperimentRunner all(study, basis, methods, testing::kFactory);
    for (std::int64_t index = 0; index < 6; ++index) {
      const ExperimentRecord record = all.run(index, StorePolicy::all);
      REQUIRE(record.status == ExperimentStatus::ok);
      ExperimentRunner alone(study, basis, methods, testing::kFactory);
      const ExperimentRecord again = alone.run(index, StorePolicy::all);
      CHECK(again.ivar_basis == record.ivar_basis);
      CHECK(again.loop->trajectory.y == record.loop->trajectory.y);
      for (std::size_t method = 0; method < methods.size(); ++method) {
        CHECK(again.assessments[method].status == AssessmentStatus::ok);
        CHECK(again.assessments[method].score == record.assessments[method].score);
        CHECK(all.assess(record)[method].score == record.assessments[method].score);
      }
    }
  }
}

TEST_CASE(
    "worlds: the methods know the benchmark of the world, and the truth is the same loop without the fault",
    "[worlds]") {
  const Study study = world_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const BasisCase zero = world_basis(study, basis, 0, testing::kFactory);
  const BasisCase one = world_basis(study, basis, 1, testing::kFactory);
  CHECK(zero.trajectory.y != one.trajectory.y);
  CHECK(zero.trajectory.y != basis.trajectory.y);
  CHECK(zero.sensitivity.active.size() == basis.sensitivity.active.size());
  ExperimentRunner runner(study, basis, {"sse"}, testing::kFactory);
  const ExperimentRecord healthy = runner.run(first_of(study, ExperimentKind::healthy, 1), StorePolicy::none);
  REQUIRE(healthy.cost);
  CHECK(healthy.ivar_basis == Eigen::VectorXd::Ones(study.cv_count()));
  CHECK_FALSE(has_impact(study.diagnosis, healthy));
  const ExperimentRecord faulty = runner.run(first_of(study, ExperimentKind::ud, 1), StorePolicy::none);
  REQUIRE(faulty.cost);
  CHECK(faulty.cost->variance_ratio == faulty.ivar_basis);
  CHECK(has_impact(study.diagnosis, faulty) == faulty.cost->has_impact(study.diagnosis.impact_upper));
}

TEST_CASE(
    "worlds: the experiments of a world that is not stable are left out by its stability, whether they run "
    "to "
    "their end or not, and say so",
    "[worlds]") {
  // Errors of 5 % leave a third of the worlds of the column unstable, and its hard limits keep their loops
  // finite.
  Study study = find_study("suite-column");
  study.world = WorldRanges{.count = 12,
                            .gain_factor = Distribution::uniform(0.95, 1.05),
                            .time_constant_factor = Distribution::uniform(0.95, 1.05),
                            .cost_loops = 1,
                            .repair_loops = 0};
  study.experiments = {.healthy = 12};
  study.diagnosis.unstable = UnstableLoops::exclude;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const LoopStability stability(study, basis.point);
  ExperimentRunner runner(study, basis, {"sse"}, testing::kFactory);
  int unstable = 0;
  for (std::int64_t index = 0; index < 12; ++index) {
    const ExperimentRecord record = runner.run(index, StorePolicy::none);
    const bool stable = stability.spectral_radius(basis_draw(record.draw.world)) < 1.0;
    CHECK((record.status == ExperimentStatus::ok) == stable);
    if (record.status != ExperimentStatus::unstable)
      continue;
    ++unstable;
    CHECK_THAT(record.message, Catch::Contains("is not stable without a fault: spectral radius 1."));
    CHECK(record.assessments.front().status == AssessmentStatus::not_assessed);
  }
  CHECK(unstable > 0);
}

TEST_CASE("worlds: calibration has worlds of its own", "[worlds]") {
  Study study = world_study();
  study.calibration = CalibrationOptions{.healthy = 4, .ud = 2};
  const Study loops = calibration_study(study);
  REQUIRE(loops.world);
  CHECK_FALSE(draw_world(loops, 0).errors == draw_world(study, 0).errors);
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(loops, assessment_context(study, basis, testing::kFactory), {"sse"});
  CHECK(runner.run(0, StorePolicy::none).status == ExperimentStatus::ok);
}

}  // namespace mpm
