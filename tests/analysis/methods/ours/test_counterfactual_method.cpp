#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/counterfactual_loop.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {

// Seed 20150401: experiment 0 has a mismatch on y2, experiment 15 a disturbance on y1, both with an impact.
TEST_CASE("counterfactual: the basis case is healthy, a fault is flagged and its CV located") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  Assessor assessor(assessment_method("counterfactual"), context);
  CHECK_FALSE(assessor.assess(assessed_loop(study, basis.point, basis.trajectory)).flagged);
  for (const std::int64_t index : {0, 15}) {
    const ExperimentDraw draw = draw_experiment(study, index);
    const Assessment said = assessor.assess(
        assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)));
    CHECK(said.flagged);
    CHECK(said.worst_cv() == draw.true_cv());
  }
}

TEST_CASE("windows: methods that simulate or filter a loop do so from the start of the record") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const AssessedLoop record = assessed_loop(
      study, basis.point, simulate_experiment(study, draw_experiment(study, 15), testing::kFactory));
  for (const char* method : {"botelho", "counterfactual"}) {
    INFO(method);
    Assessor assessor(assessment_method(method), context);
    const auto ivar_of = [&](const AssessedLoop& loop) {
      const Assessment said = assessor.assess(loop);
      REQUIRE(said.status == AssessmentStatus::ok);
      return said.number("ivar", 0);
    };
    // The window that is the whole record is judged as the record is.
    CHECK(ivar_of(window_of(record, 0, record.samples())) == ivar_of(record));
  }
  // Of a window in mid-record y0 is that of the record, cut: filtered anew from there it would be another
  // one.
  Assessor chain(assessment_method("botelho"), context);
  Trajectory loop;
  loop.y = record.y;
  loop.u = record.u;
  loop.u_target = record.u_target;
  loop.d = record.d;
  const NominalOutputs nominal =
      NominalEstimator(study, basis.point, basis.sensitivity, testing::kFactory).estimate(loop, record.y_sim);
  const Eigen::VectorXd expected =
      variance_indices(record.y.middleCols(150, 200), nominal.y0.middleCols(150, 200));
  const Assessment said = chain.assess(window_of(record, 150, 200));
  for (Eigen::Index cv = 0; cv < expected.size(); ++cv)
    CHECK(said.number("ivar", cv) == expected(cv));
}

TEST_CASE("counterfactual: where no loop runs under the errors of the others, Ivar names the CV") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  CounterfactualLoop nominal(context);
  const ExperimentDraw draw = draw_experiment(study, 15);
  const CounterfactualLoop::Impact impact =
      nominal.impact(assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)));
  Assessment said = impact.assessment;
  REQUIRE(said.flagged);
  Eigen::VectorXd ivar_diag = Eigen::VectorXd::Constant(study.cv_count(), kNaN);
  said.cvs = nominal.located(ivar_diag, impact);
  CHECK(said.worst_cv() == draw.true_cv());
  CHECK(said.cvs[static_cast<std::size_t>(draw.true_cv())].flagged == true);
  ivar_diag(1) = 1.0;  // the one that does run is asked
  said.cvs = nominal.located(ivar_diag, impact);
  CHECK(said.worst_cv() == 1);
  CHECK(said.cvs[1].flagged == false);
  CHECK_FALSE(said.cvs[0].flagged.has_value());
}

// A level in its range has another variance in each record, whatever the model is: here the model is exact.
TEST_CASE("counterfactual: a variance that noise alone can make is no impact") {
  Study study = find_study("suite-column-levels");
  study.experiments = {.healthy = 12};
  study.simulation.excitation = SignalSequence::each;
  study.world = WorldRanges{.count = 1};
  study.world->background.cv_size = Distribution::constant(0.4);
  study.world->background.time_constant = Distribution::constant(10.0);
  const auto flagged_with = [&](AssessmentModel model) {
    study.assessment.model = model;
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    ExperimentRunner runner(study, basis, {"counterfactual"}, testing::kFactory);
    int flagged = 0;
    for (std::int64_t index = 0; index < study.experiments.healthy; ++index) {
      const ExperimentRecord record = runner.run(index, StorePolicy::none);
      REQUIRE(record.assessments.size() == 1);
      REQUIRE(record.assessments.front().answered());
      flagged += record.assessments.front().flagged ? 1 : 0;
    }
    return flagged;
  };
  CHECK(flagged_with(AssessmentModel::nominal) > 6);
  CHECK(flagged_with(AssessmentModel::benchmark) <= 1);  // of a probability of 1 %: two have one of 0.6 %
}

TEST_CASE("counterfactual: with the simulation errors of all CVs added, the loop of the model gives y back") {
  const Study study = find_study("chapter6");
  const OperatingPoint point = run_basis_case(study, testing::kFactory).point;
  const Trajectory loop = simulate_experiment(study, draw_experiment(study, 15), testing::kFactory);
  const AssessedLoop seen = assessed_loop(study, point, loop);
  const LoopSignals signals{.d = seen.d,
                            .noise = Eigen::MatrixXd::Zero(seen.y.rows(), seen.samples()),
                            .y_d = seen.y - seen.y_sim,
                            .y_set = setpoints(study)};
  const Trajectory again = run_closed_loop(study, study.plant.G, signals, testing::kFactory);
  REQUIRE(again.status == ControlStatus::ok);
  // The sums are the same to rounding, and the moves to the accuracy of the solver (KKT residual 1e-7).
  CHECK((again.y - seen.y).cwiseAbs().maxCoeff() < 1e-6);
}

// The disturbances act through the controller, so that a plant with another dead time has another variance.
TEST_CASE("counterfactual: Ivar of a healthy loop does not depend on the clock of its record") {
  const auto ivar_with = [](double shift) {
    Study study = find_study("wood-berry");
    study.assessment.model = AssessmentModel::benchmark;
    study.record.cv_shift = std::vector<double>(2, shift);
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
    Assessor assessor(assessment_method("counterfactual"), context);
    ExperimentDraw healthy;
    healthy.index = 6;
    const Trajectory loop = simulate_experiment(study, healthy, testing::kFactory);
    const Assessment said =
        assessor.assess(assessed_loop(study, basis.point, recorded(study, healthy.index, loop)));
    CHECK_FALSE(said.flagged);
    return Eigen::Vector2d(said.number("ivar", 0), said.number("ivar", 1));
  };
  const Eigen::Vector2d on_time = ivar_with(0.0);
  for (const double shift : {1.0, -1.0, 0.5, -0.5}) {
    INFO("rows early by " << shift << " samples");
    CHECK((ivar_with(shift) - on_time).cwiseAbs().maxCoeff() < 0.02);
  }
}

}  // namespace mpm
