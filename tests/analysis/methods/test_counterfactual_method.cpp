#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/methods/method_table.hpp"
#include "scenarios/closed_loop.hpp"
#include "scenarios/signals.hpp"
#include "scenarios/study_library.hpp"
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

}  // namespace mpm
