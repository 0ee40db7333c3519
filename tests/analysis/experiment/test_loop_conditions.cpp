// With which constraints a loop works, and what a study does with loops that are not stable.

#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/findings/study_findings.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

using testing::kFactory;

struct Basis {
  Study study = find_study("chapter6");
  BasisCase basis;

  Basis() {
    basis.sensitivity.is_known = true;
    basis.point.active = {{0, ConstraintKind::lower_limit}};
    basis.point.fixed_mvs = {2};
  }
  /// A record of 10 samples in the middle of all ranges, of which 8 were done.
  Trajectory quiet() const {
    Trajectory loop;
    loop.y = Eigen::MatrixXd::Constant(7, 10, 0.25);
    loop.y.row(6).setConstant(-0.25);
    loop.u = Eigen::MatrixXd::Zero(3, 10);
    loop.samples_done = 8;
    return loop;
  }
};

TEST_CASE("conditions: shares of the samples in which another constraint is met", "[loop_conditions]") {
  const Basis given;
  Trajectory loop = given.quiet();
  loop.y.row(0).setConstant(-3.0);  // active: it is to be at its limit
  loop.u.row(2).setConstant(0.5);   // fixed
  LoopConditions conditions = loop_conditions(given.study, given.basis, loop);
  CHECK(conditions.other_cv_active == 0.0);
  CHECK(conditions.mv_at_limit == 0.0);
  CHECK_FALSE(conditions.stable().has_value());

  loop.y(1, 3) = 0.0;    // at the lower limit of y2
  loop.y(6, 3) = 0.001;  // over the upper one of y7 in the same sample
  loop.y(4, 5) = -0.6;
  loop.y(4, 9) = -0.6;  // after the end
  loop.u(0, 0) = -0.5;
  conditions = loop_conditions(given.study, given.basis, loop);
  CHECK(conditions.other_cv_active == 2.0 / 8.0);
  CHECK(conditions.mv_at_limit == 1.0 / 8.0);
}

TEST_CASE("conditions: not known without an active set, or without a sample", "[loop_conditions]") {
  Basis given;
  Trajectory loop = given.quiet();
  loop.samples_done = 0;
  CHECK(std::isnan(loop_conditions(given.study, given.basis, loop).other_cv_active));
  given.basis.sensitivity.is_known = false;
  CHECK(std::isnan(loop_conditions(given.study, given.basis, given.quiet()).mv_at_limit));
}

TEST_CASE("conditions: the first cause counts, and what is not known is none", "[loop_conditions]") {
  CHECK(first_cause({}) == NonlinearCause::none);
  CHECK(has_cause({}, NonlinearCause::none));
  const LoopConditions all{1.0, 0.5, 0.5};
  CHECK(first_cause(all) == NonlinearCause::unstable);
  for (const NonlinearCause cause : kNonlinearCauses)
    CHECK(has_cause(all, cause) == (cause != NonlinearCause::none));
  CHECK(first_cause({0.99, kOftenActive, 0.5}) == NonlinearCause::mv_at_limit);
  CHECK(first_cause({0.99, 0.2, 0.5}) == NonlinearCause::other_cv_active);
  CHECK(all.stable() == false);
}

TEST_CASE("conditions: unstable loops are kept, or left out and counted", "[loop_conditions]") {
  Study study = find_study("chapter4-shell");
  study.simulation.samples = 200;
  study.diagnosis.self_check = SelfCheck::none;
  const Mismatch mismatch{2, 2, MismatchParameter::gain, 3.5};
  study.scenarios = {
      {.name = "rings", .description = "", .mismatches = {mismatch}, .disturbances = {}, .affected_cvs = {}}};
  const BasisCase basis = run_basis_case(study, kFactory);
  const auto record = [&] {
    return ExperimentRunner(study, basis, {"botelho"}, kFactory).run(0, StorePolicy::all);
  };
  const auto endings = [&](const ExperimentRecord& of) {
    Endings result;
    result.add(of);
    result.finish(0.95);
    return result;
  };
  const ExperimentRecord kept = record();
  CHECK(kept.status == ExperimentStatus::ok);
  CHECK(kept.conditions.stable() == false);
  CHECK(kept.assessments.front().answered());
  CHECK((endings(kept).unstable.hits == 1 && endings(kept).excluded == 0));

  study.diagnosis.unstable = UnstableLoops::exclude;
  const ExperimentRecord excluded = record();
  CHECK(excluded.status == ExperimentStatus::unstable);
  CHECK(excluded.conditions.spectral_radius == kept.conditions.spectral_radius);
  CHECK_FALSE(excluded.assessments.front().answered());
  CHECK(excluded.ivar_basis.size() == 0);
  CHECK(excluded.loop);
  CHECK((endings(excluded).unstable.hits == 1 && endings(excluded).excluded == 1));
  CHECK(endings(excluded).infeasible.hits == 0);
}

}  // namespace
}  // namespace mpm
