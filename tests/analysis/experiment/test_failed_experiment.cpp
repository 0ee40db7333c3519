#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"
#include "tests/analysis/experiment/brittle_tank.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What a plant cannot do is the outcome of an experiment, unless it is the study's plant.

namespace {

using namespace mpm;
using Catch::Contains;

/// A study on the nonlinear tank whose loops begin at the economic optimum, not at the operating point.
Study tank_study() {
  return find_study("chapter2-tank");
}

TEST_CASE("a plant that cannot be integrated fails the experiment, not the basis case") {
  Study study = tank_study();
  study.scenarios = {{"M1", "", {}, {}, std::vector<Eigen::Index>{0}, {{"cd2", 2.0}}},
                     {"none", "", {}, {}, {}}};
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>& changes) {
    return std::make_shared<const testing::BrittleTank>(true, changes.empty());
  };
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  REQUIRE(basis.trajectory.status == ControlStatus::ok);
  ExperimentRunner runner(study, basis, {"botelho"}, testing::kFactory);
  const ExperimentRecord failed = runner.run(0, StorePolicy::all);
  CHECK(failed.status == ExperimentStatus::failed);
  CHECK(failed.message == "the plant could not be integrated");
  CHECK(failed.loop->trajectory.samples_done == 0);
  REQUIRE(failed.assessments.size() == 1);
  CHECK(failed.assessments[0].status == AssessmentStatus::not_assessed);
  const ExperimentRecord next = runner.run(1, StorePolicy::none);  // the runner is none the worse for it
  CHECK(next.status == ExperimentStatus::ok);
  CHECK(next.message.empty());
}

TEST_CASE("a study whose own plant cannot rest where its loops begin is refused") {
  Study study = tank_study();
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>&) {
    return std::make_shared<const testing::BrittleTank>(false, true);
  };
  CHECK_THROWS_AS(run_basis_case(study, testing::kFactory), InputError);
  CHECK_THROWS_WITH(run_basis_case(study, testing::kFactory),
                    Contains("found the plant has no steady state to begin at") && Contains("not finite"));
}

TEST_CASE("a basis case whose plant cannot be integrated is not healthy, and says why") {
  Study study = tank_study();
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>&) {
    return std::make_shared<const testing::BrittleTank>(true, false);
  };
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  CHECK_FALSE(basis.healthy);
  CHECK(basis.explanation == "the nominal loop fails at sample 0: the plant could not be integrated");
}

}  // namespace
