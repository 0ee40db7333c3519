#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "plants/outside/program_model.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What `assessment.model = "automatic"` means.

namespace mpm {
namespace {

struct Assumed {
  ModelAssumption assumption;
  bool corrects;
};

Assumed assumed(const Study& study, const BasisCase& basis) {
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  return {model_assumption(context), context.correction != nullptr};
}

}  // namespace

TEST_CASE("the plant and its benchmark decide whether the model is taken for exact") {
  Study linear = find_study("wood-berry");
  const Assumed exact = assumed(linear, run_basis_case(linear, testing::kFactory));
  CHECK(exact.assumption.model == AssessmentModel::nominal);
  CHECK_FALSE(exact.corrects);

  Study tank = find_study("chapter5-tank");
  const BasisCase of_tank = run_basis_case(tank, testing::kFactory);
  REQUIRE(tank.nonlinear);
  const Assumed curved = assumed(tank, of_tank);
  CHECK(curved.assumption.model == AssessmentModel::benchmark);
  CHECK(curved.corrects);
  CHECK(curved.assumption.why.find("rejects an exact model of h") != std::string::npos);

  // The benchmark is that of the tank: nothing starts the program.
  Study program = tank;
  ProgramSettings settings;
  settings.command = {"nobody-starts-this"};
  program.nonlinear->model.foreign = program_model(settings, {.settle = 1.0});
  const Assumed foreign = assumed(program, of_tank);
  CHECK(foreign.assumption.model == AssessmentModel::benchmark);
  CHECK(foreign.corrects);
  CHECK(to_string(foreign.assumption) ==
        "assessment.model: benchmark, because the plant is a program, which no linear model matches exactly");

  for (Study* const study : {&linear, &tank, &program})
    study->assessment.model = AssessmentModel::nominal;
  CHECK_FALSE(assumed(tank, of_tank).corrects);
  CHECK_FALSE(assumed(program, of_tank).corrects);
}

TEST_CASE(
    "the benchmark says by how much the outputs are early or late: the model follows, the plant does not") {
  for (const double shift : {0.0, 1.0, -1.0}) {
    Study study = find_study("wood-berry");
    study.assessment.model = AssessmentModel::benchmark;
    study.record.cv_shift = std::vector<double>(2, shift);
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    const std::shared_ptr<const LearntModel> learnt =
        learnt_model(assessment_context(study, basis, testing::kFactory));
    INFO("rows early by " << shift << " samples");
    REQUIRE(learnt);
    CHECK(learnt->late() == -shift * study.controller.sample_time);
    CHECK(learnt->rejects_exact_model().has_value() == (shift != 0.0));
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
      for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
        const double dead_time = study.plant.G(cv, mv).dead_time();
        CHECK(learnt->of(cv).model()(0, mv).dead_time() ==
              Approx(dead_time + std::max(0.0, learnt->late())).margin(0.2));
        CHECK(learnt->plant()(cv, mv).dead_time() == Approx(dead_time).margin(0.2));
      }
  }
}

// What is early cannot be had from a shorter dead time there.
TEST_CASE("a benchmark that is early explains the next record, also where the plant has no dead time") {
  Study study = find_study("suite-column");
  study.assessment.model = AssessmentModel::benchmark;
  study.record.cv_shift = std::vector<double>(2, 1.0);
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const std::shared_ptr<const LearntModel> learnt = learnt_model(context);
  REQUIRE(learnt);
  CHECK(learnt->late() == -study.controller.sample_time);
  ExperimentDraw healthy;
  healthy.index = 6;
  const AssessedLoop loop =
      assessed_loop(study, basis.point,
                    recorded(study, healthy.index, simulate_experiment(study, healthy, testing::kFactory)));
  const std::shared_ptr<const AssessedLoop> corrected = learnt->corrected(loop);
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    INFO("CV " << cv);
    const Eigen::Index compared = loop.samples() - 1;  // the last row is of a sample beyond the inputs
    const Eigen::RowVectorXd e = (loop.y - corrected->y_sim).row(cv).head(compared);
    CHECK(std::sqrt(e.squaredNorm() / static_cast<double>(compared)) <
          1.2 * deviation_of_steps(learnt->errors(*context.benchmark, cv)));
    CHECK(learnt->plant()(cv, 0).dead_time() < 0.2 * study.controller.sample_time);
  }
}

}  // namespace mpm
