#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/fault_scale.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace {

using namespace mpm;

/// The setpoint loops of the Shell fractionator, with faults that are to change a variance by a third to
/// twice.
Study study_with_impact() {
  Study study = find_study("setpoint-methods");
  study.simulation.samples = 400;
  study.simulation.setpoint_steps.resize(6);
  study.experiments = {.mpm = 1, .ud = 1, .other = 1};
  const Distribution impact = Distribution::log_uniform(1.0 / 3.0, 2.0);
  study.mismatch.impact = study.disturbance.impact = study.other.impact = impact;
  study.other.weight = {1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0};
  return study;
}

double effect_of(const ExperimentRecord& record) {
  double largest = 0.0;
  for (const AffectedCv& affected : record.draw.affected())
    largest = std::max(largest, std::abs(record.ivar_basis(affected.cv) - 1.0));
  return largest;
}

TEST_CASE("faults of a given effect: the variance of the affected CV changes by what was asked for") {
  Study study = study_with_impact();
  study.mismatch.impact = study.disturbance.impact = study.other.impact = Distribution::constant(0.7);
  study.mismatch.parameter_weight = {1.0, 1.0, 0.0, 0.0, 0.0, 0.0};
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"sse"}, testing::kFactory);
  int reached = 0, experiments = 0, scaled = 0;
  for (std::int64_t i = 0; i < 24; ++i) {
    const ExperimentRecord record = runner.run(i, StorePolicy::none);
    if (record.status != ExperimentStatus::ok)
      continue;
    ++experiments;
    reached += std::abs(effect_of(record) / 0.7 - 1.0) < 0.031 ? 1 : 0;
    scaled += record.draw.scales == FaultScales{} ? 0 : 1;
    CHECK(effect_of(record) > 0.0);
  }
  CHECK(scaled >= experiments - 2);
  CHECK(reached >= experiments * 2 / 3);  // a mismatch need not be able to
}

TEST_CASE("faults of a given effect: it is that of the loop itself, and a dead time stays >= 0") {
  Study study = study_with_impact();
  study.experiments = {.mpm = 1, .ud = 1};
  study.mismatch.parameter_weight = {0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  study.mismatch.dead_time_shift = Distribution::constant(-2.0);
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  SolverStatistics pilots;
  for (std::int64_t i = 0; i < 4; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    const FaultScales scales = scales_for_impact(study, draw, basis.trajectory.y, testing::kFactory, pilots);
    const ExperimentDraw sized = with_scales(study, draw, scales);
    for (const Mismatch& mismatch : sized.mismatches)
      CHECK(mismatch.value >= -study.plant.G(mismatch.cv, mismatch.input).dead_time() - 1e-12);
    const Trajectory loop = simulate_experiment(study, sized, testing::kFactory);
    CHECK(std::isfinite(effect(study, sized, loop, basis.trajectory.y)));
  }
  CHECK(pilots.steps > 4 * 400);
}

TEST_CASE("scales: factors are raised to them, shifts and gains multiplied, and 1 changes nothing") {
  const Study study = find_study("chapter6");
  ExperimentDraw draw;
  draw.kind = ExperimentKind::mpm_ud;
  draw.mismatches = {{0, 0, MismatchParameter::gain, 1.3},
                     {0, 1, MismatchParameter::dead_time, -2.0},
                     {0, 2, MismatchParameter::sign, -1.0},
                     {1, 0, MismatchParameter::second_order, 5.0}};
  draw.disturbances = {{0, 0.4, 30.0}};
  draw.other = OtherFault{OtherFaultKind::stiction, 0, 0.2, 0.1};
  const ExperimentDraw scaled = with_scales(study, draw, {2.0, 3.0, 0.5});
  CHECK(scaled.mismatches[0].value == Approx(1.69));
  CHECK(scaled.mismatches[1].value == Approx(-4.0));
  CHECK(scaled.mismatches[2].value == -1.0);
  CHECK(scaled.mismatches[3].value == Approx(10.0));
  CHECK(scaled.disturbances[0].gain == Approx(1.2));
  CHECK(scaled.other->size == Approx(0.1));
  CHECK(scaled.other->jump == Approx(0.05));
  CHECK(with_scales(study, draw, {}).mismatches == draw.mismatches);
}

}  // namespace
