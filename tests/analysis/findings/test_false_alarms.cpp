#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/basis/tuned_basis.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/false_alarms.hpp"
#include "analysis/findings/study_findings.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace {

using namespace mpm;

/// Chapter 6 with bad tunings only.
Study tuning_study() {
  Study study = find_study("chapter6");
  study.experiments = {.tuning = 1};
  study.s0_perturbation = {};
  return study;
}

const QpSolverFactory& factory() {
  static const QpSolverFactory made = qp_solver_factory("active-set");
  return made;
}

/// The first experiment with this parameter.
std::int64_t index_of(const Study& study, TuningParameter parameter) {
  std::int64_t index = 0;
  while (draw_experiment(study, index).tuning->parameter != parameter)
    ++index;
  return index;
}

/// A record without a loop; a source flags it.
ExperimentRecord made_up(ExperimentKind kind, ExperimentStatus status,
                         FaultSource source = FaultSource::none) {
  ExperimentRecord record;
  record.draw.kind = kind;
  if (kind == ExperimentKind::tuning)
    record.draw.tuning = TuningChange{TuningParameter::slack_weight, 0, 2.0};
  record.status = status;
  record.assessments = {testing::verdict(testing::chain_form(), source != FaultSource::none, 1.0, 2, source)};
  return status == ExperimentStatus::ok ? record : testing::without_verdict(record, status);
}

TEST_CASE("tuned_basis: S0 of the changed controller, only where the study takes it", "[false_alarms]") {
  Study study = tuning_study();
  const ExperimentDraw draw = draw_experiment(study, index_of(study, TuningParameter::move_suppression));
  CHECK_FALSE(tuned_basis(study, basis_draw(), factory()));
  const std::optional<TunedBasis> own = tuned_basis(study, draw, factory());
  REQUIRE(own);
  Study by_hand = study;
  by_hand.controller.move_suppression(draw.tuning->index) *= draw.tuning->factor;
  const OperatingPoint point = operating_point(by_hand, factory());
  const NominalSensitivity expected = nominal_sensitivity(by_hand, point, factory());
  REQUIRE(own->basis.sensitivity.step_response.size() == expected.step_response.size());
  for (std::size_t a = 0; a < expected.step_response.size(); ++a)
    CHECK(own->basis.sensitivity.step_response[a] == expected.step_response[a]);
  const NominalSensitivity design = nominal_sensitivity(study, operating_point(study, factory()), factory());
  CHECK(own->basis.sensitivity.step_response[0] != design.step_response[0]);
  // The basis loop, and a step of each active limit.
  CHECK(own->solver.steps == study.simulation.samples + static_cast<std::int64_t>(expected.active.size()) *
                                                            study.sensitivity.samples);
  CHECK(own->solver.largest_kkt_residual < 1e-6);

  study.tuning.sensitivity = TuningSensitivity::design;
  CHECK_FALSE(tuned_basis(study, draw, factory()));
}

TEST_CASE("a bad tuning is diagnosed by its own S0 against the basis case of the study", "[false_alarms]") {
  Study study = tuning_study();
  const BasisCase basis = run_basis_case(study, factory());
  const std::int64_t index = index_of(study, TuningParameter::move_suppression);
  const ExperimentRecord record =
      ExperimentRunner(study, basis, {"botelho"}, factory()).run(index, StorePolicy::all);
  REQUIRE(record.status == ExperimentStatus::ok);
  const Trajectory& loop = record.loop->trajectory;

  const std::optional<TunedBasis> own = tuned_basis(study, record.draw, factory());
  const NominalOutputs nominal =
      NominalEstimator(own->study, own->basis.point, own->basis.sensitivity, factory()).estimate(loop);
  const Diagnosis expected = DiagnosisChain(study).diagnose(loop.y, nominal);
  CHECK(record.chain().values("ivar") == expected.ivar);
  CHECK(record.chain().number("i_mpm") == expected.indicator.i_mpm);
  CHECK(record.ivar_basis == basis_variance_indices(study, loop.y, basis.trajectory.y));
  CHECK(record.perturbed.damping.size() == 0);

  study.tuning.sensitivity = TuningSensitivity::design;
  const ExperimentRecord unnoticed =
      ExperimentRunner(study, basis, {"botelho"}, factory()).run(index, StorePolicy::none);
  const NominalOutputs of_design =
      NominalEstimator(study, basis.point, basis.sensitivity, factory()).estimate(loop);
  CHECK(unnoticed.chain().values("ivar") == DiagnosisChain(study).diagnose(loop.y, of_design).ivar);
  CHECK(unnoticed.chain().values("ivar") != record.chain().values("ivar"));
}

TEST_CASE("without noise no tuning makes an alarm, whatever S0", "[false_alarms]") {
  // Model and plant agree, so that y = y_sim and y0 = y for any S0: Ivar = 1 up to the rounding of sums.
  Study study = tuning_study();
  study.simulation.noise_standard_deviation.setZero();
  for (const TuningSensitivity sensitivity : {TuningSensitivity::current, TuningSensitivity::design}) {
    study.tuning.sensitivity = sensitivity;
    const BasisCase basis = run_basis_case(study, factory());
    ExperimentRunner runner(study, basis, {"botelho"}, factory());
    for (const TuningParameter parameter :
         {TuningParameter::move_suppression, TuningParameter::target_weight, TuningParameter::slack_weight}) {
      const ExperimentRecord record = runner.run(index_of(study, parameter), StorePolicy::none);
      REQUIRE(record.status == ExperimentStatus::ok);
      CHECK((record.chain().values("ivar").array() - 1.0).abs().maxCoeff() < 1e-6);
      CHECK((record.chain().values("ivar_diag").array() - 1.0).abs().maxCoeff() < 1e-6);
      CHECK_FALSE(judge(study, record, record.assessments[0]).wrong());
    }
  }
}

TEST_CASE("a controller that does not run on its own model makes the experiment infeasible",
          "[false_alarms]") {
  // Halved hard limits of the CVs leave a badly tuned controller hardly any room: some run on their own model
  // with the noise of the experiment, but not with that of the basis case.
  Study study = tuning_study();
  study.controller.cv_hard.lower *= 0.5;
  study.controller.cv_hard.upper *= 0.5;
  const BasisCase basis = run_basis_case(study, factory());
  REQUIRE(basis.trajectory.status == ControlStatus::ok);
  ExperimentRunner runner(study, basis, {"botelho"}, factory());
  int only_own = 0;
  for (std::int64_t index = 25; index < 60; ++index) {
    const ExperimentDraw draw = draw_experiment(study, index);
    const std::optional<TunedBasis> own = tuned_basis(study, draw, factory());
    if (own->basis.trajectory.status == ControlStatus::ok)
      continue;
    CHECK_FALSE(own->basis.explanation.empty());
    const ExperimentRecord record = runner.run(index, StorePolicy::none);
    CHECK(record.status == ExperimentStatus::infeasible);
    CHECK(record.chain().values("ivar").size() == 0);
    only_own += simulate_experiment(study, draw, factory()).status == ControlStatus::ok ? 1 : 0;
  }
  CHECK(only_own > 0);
}

TEST_CASE("false_alarms counts each kind, and each parameter that the controller has", "[false_alarms]") {
  Study study = find_study("chapter6");
  CHECK(false_alarm_collector(study, 0).of({}).empty());
  study.experiments = {.mpm = 1, .healthy = 1, .tuning = 1};
  const auto healthy = ExperimentKind::healthy, tuning = ExperimentKind::tuning;
  const std::vector<ExperimentRecord> records{
      made_up(healthy, ExperimentStatus::ok),
      made_up(healthy, ExperimentStatus::ok, FaultSource::mpm),
      made_up(healthy, ExperimentStatus::ok),
      made_up(healthy, ExperimentStatus::infeasible),
      made_up(tuning, ExperimentStatus::ok, FaultSource::ud),
      made_up(tuning, ExperimentStatus::ok, FaultSource::mpm),
      made_up(tuning, ExperimentStatus::failed),
  };
  const std::vector<FalseAlarms> groups = false_alarm_collector(study, 0).of(records);
  REQUIRE(groups.size() == 5);  // without the setpoint weights, which no CV has
  CHECK(groups[0].name() == "healthy");
  CHECK(groups[0].experiments == 4);
  CHECK((groups[0].infeasible.hits == 1 && groups[0].infeasible.total == 4));
  CHECK((groups[0].false_alarm.hits == 1 && groups[0].false_alarm.total == 3));
  CHECK((groups[0].false_mpm.hits == 1 && groups[0].false_ud.hits == 0));
  CHECK(groups[1].name() == "tuning");
  CHECK((groups[1].failed == 1 && groups[1].false_alarm.hits == 2 && groups[1].false_alarm.total == 2));
  CHECK((groups[1].false_mpm.hits == 1 && groups[1].false_ud.hits == 1));
  CHECK(groups[2].name() == "tuning_move_suppression");
  CHECK(groups[2].experiments == 0);
  CHECK(groups[4].name() == "tuning_slack_weight");
  CHECK(groups[4].false_alarm.total == 2);

  const StudyFindings findings = study_findings(study, {testing::chain_form()}, records);
  CHECK(findings.experiments == 7);
  CHECK(findings.chain()->kinds.size() == 1);  // the kinds with a fault
  CHECK(findings.chain()->false_alarms.size() == groups.size());
  const Finding* const found = find_finding(findings.rows, "false_alarm_healthy");
  REQUIRE(found != nullptr);
  CHECK(found->count == 3);
  CHECK(found->hits == 1);
  // Wilson (1927) for 1 of 3 and z = 1.96: (1/3 + z^2/6 -+ z sqrt(2/27 + z^2/36)) / (1 + z^2/3).
  CHECK(found->interval.lower == Approx(0.0615).margin(5e-4));
  CHECK(found->interval.upper == Approx(0.7923).margin(5e-4));
}

}  // namespace
