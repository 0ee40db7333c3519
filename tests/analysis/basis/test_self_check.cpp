#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

BasisCase basis_of(const std::vector<StudyChange>& changes) {
  const Study study = changed_study(find_study("wood-berry"), changes, "changed");
  return run_basis_case(study, qp_solver_factory("active-set"));
}

/// Why the basis case of the changed study is not healthy.
std::string trouble(const std::vector<StudyChange>& changes) {
  const BasisCase basis = basis_of(changes);
  CHECK_FALSE(basis.healthy);
  return basis.explanation;
}

TEST_CASE("self-check: T0 that has not settled is no sensitivity") {
  CHECK(basis_of({}).healthy);
  CHECK_THAT(trouble({{"sensitivity.samples", "2"}}), Contains("T0 of xD has not settled after 2 samples"));
  CHECK_THAT(trouble({{"sensitivity.samples", "10"}}), Contains("has not settled after 10 samples"));
}

TEST_CASE("self-check: a step that is lost in rounding gives no T0") {
  CHECK(basis_of({{"sensitivity.step_size", "0.001"}}).healthy);
  CHECK_THAT(trouble({{"sensitivity.step_size", "1e-14"}}), Contains("T0 of xD"));
}

TEST_CASE("self-check: without a reference T0 is zero, unless nothing is asked") {
  const Study study = find_study("chapter3-tank-soft");  // ranges alone, and no CV at a limit
  CHECK_THAT(run_basis_case(study, qp_solver_factory("active-set")).explanation, Contains("T0 is zero"));
}

TEST_CASE("self-check: a loop without noise and excitation is not judged") {
  Study study = find_study("wood-berry");
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.steps.clear();
  study.simulation.random_steps = false;
  REQUIRE_FALSE(study.simulation.is_excited());
  for (const SelfCheck check : {SelfCheck::ivar, SelfCheck::repeat}) {
    study.diagnosis.self_check = check;
    const BasisCase basis = run_basis_case(study, qp_solver_factory("active-set"));
    CHECK_FALSE(basis.healthy);
    CHECK_THAT(basis.explanation, Contains("stands still"));
  }
}

}  // namespace
