#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/ours/fault_posterior.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "tests/solvers/active_set_factory.hpp"

// A valve that sticks is neither a mismatch nor a disturbance.

namespace mpm {
namespace {

/// wood-berry, whose methods learn the errors of the model.
Study learning_study() {
  Study study = find_study("wood-berry");
  study.assessment.model = AssessmentModel::benchmark;
  return study;
}

ExperimentDraw draw_of(ExperimentKind kind, std::int64_t index) {
  ExperimentDraw draw;
  draw.kind = kind;
  draw.index = index;
  return draw;
}

}  // namespace

TEST_CASE("the likelihood names a valve that sticks, and only such a one", "[valve]") {
  const Study study = learning_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"likelihood"});
  const auto said = [&](const ExperimentDraw& draw) {
    return panel
        .assess(assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)),
                nullptr)
        .front();
  };
  const double range = study.controller.mv_hard.upper(0) - study.controller.mv_hard.lower(0);
  REQUIRE(std::isfinite(range));
  struct Tried {
    OtherFaultKind kind;
    double size, jump;  ///< over the hard range, over the size
  };
  for (const Eigen::Index mv : {0, 1})
    for (const auto& [kind, size, jump] :
         {Tried{OtherFaultKind::deadband, 0.1, 0.0}, Tried{OtherFaultKind::stiction, 0.1, 0.7},
          Tried{OtherFaultKind::stick_slip, 0.03, 0.0}, Tried{OtherFaultKind::friction, 0.05, 0.5}}) {
      ExperimentDraw sticks = draw_of(ExperimentKind::other, 3);
      sticks.other = OtherFault{kind, mv, size * range, jump * size * range, 0.4};
      const AssessmentRecord answer = said(sticks);
      INFO("MV " << mv << ", " << to_string(kind));
      CHECK(answer.flagged);
      CHECK(answer.number("p_other") > 0.9);
      CHECK(answer.number("valve_mv") == static_cast<double>(mv));
      CHECK(answer.predicted_source == FaultSource::other);
      CHECK(answer.told() == ToldSource::valve);
      CHECK(answer.number("p_healthy") + answer.number("p_mpm") + answer.number("p_ud") +
                answer.number("p_both") + answer.number("p_other") ==
            Approx(1.0));
    }
  ExperimentDraw mismatch = draw_of(ExperimentKind::mpm, 4);
  mismatch.mismatches = {{0, 0, MismatchParameter::gain, 0.6}};
  CHECK(said(mismatch).predicted_source == FaultSource::mpm);
  CHECK(said(mismatch).number("p_other") < 0.02);
  ExperimentDraw disturbance = draw_of(ExperimentKind::ud, 5);
  disturbance.disturbances = {{0, 0.5, 20.0}};
  CHECK(said(disturbance).predicted_source == FaultSource::ud);
  CHECK_FALSE(said(draw_of(ExperimentKind::healthy, 6)).flagged);
}

// Two MVs that move the CVs nearly alike, and by a hundred times the noise: 2 % of what an MV moves is seen.
TEST_CASE("the likelihood names a valve that sticks a little where the CVs show it", "[valve]") {
  Study study = find_study("suite-column");
  study.assessment.model = AssessmentModel::benchmark;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"likelihood"});
  for (const Eigen::Index mv : {0, 1})
    for (const OtherFaultKind kind : {OtherFaultKind::deadband, OtherFaultKind::stick_slip}) {
      ExperimentDraw sticks = draw_of(ExperimentKind::other, 3);
      sticks.other = OtherFault{kind, mv, 0.01, 0.0, 0.4};
      const AssessmentRecord answer =
          panel
              .assess(
                  assessed_loop(study, basis.point, simulate_experiment(study, sticks, testing::kFactory)),
                  nullptr)
              .front();
      INFO("MV " << mv << ", " << to_string(kind));
      CHECK(answer.told() == ToldSource::valve);
      CHECK(answer.number("valve_mv") == static_cast<double>(mv));
    }
}

}  // namespace mpm
