#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/experiment/scenario_verdict.hpp"
#include "analysis/experiment/verdict.hpp"
#include "analysis/indicators/simulation_error.hpp"
#include "plants/error.hpp"
#include "scenarios/study_library.hpp"

namespace {

using namespace mpm;

using Cvs = std::vector<Eigen::Index>;

/// A scenario of three CVs: a mismatch on the first, a disturbance on the second.
ExperimentRecord scenario() {
  ExperimentRecord record;
  record.draw.named = true;
  record.draw.kind = ExperimentKind::mpm_ud;
  record.draw.mismatches = {{0, 0, MismatchParameter::gain, 2.0}};
  record.draw.disturbances = {{1, 1.0, 30.0}};
  record.status = ExperimentStatus::ok;
  record.diagnosis.cvs.resize(3);
  return record;
}

void flag(ExperimentRecord& record, std::size_t cv, ExperimentKind source) {
  record.diagnosis.cvs[cv].flagged = true;
  record.diagnosis.cvs[cv].source = source;
}

TEST_CASE("scenario verdict: each affected CV must be flagged with its source, and no other one") {
  const Study study;
  ExperimentRecord record = scenario();
  ScenarioVerdict verdict = scenario_verdict(record);
  CHECK(verdict.missed == Cvs{0, 1});
  CHECK_FALSE(verdict.judged_source);
  CHECK(record.wrong());
  CHECK(location_verdict(record) == Verdict::wrong);
  CHECK(source_verdict(study, record) == Verdict::none);

  flag(record, 0, ExperimentKind::mpm);
  flag(record, 1, ExperimentKind::ud);
  verdict = scenario_verdict(record);
  CHECK(verdict.found == Cvs{0, 1});
  CHECK(verdict.right());
  CHECK_FALSE(record.wrong());
  CHECK(location_verdict(record) == Verdict::right);
  CHECK(source_verdict(study, record) == Verdict::right);

  flag(record, 2, ExperimentKind::mpm);
  CHECK(scenario_verdict(record).false_alarms == Cvs{2});
  CHECK(location_verdict(record) == Verdict::wrong);
  CHECK(source_verdict(study, record) == Verdict::right);

  record.diagnosis.cvs[2] = {};
  flag(record, 1, ExperimentKind::mpm);
  CHECK(scenario_verdict(record).wrong_source == Cvs{1});
  CHECK(scenario_verdict(record).located());
  CHECK(record.wrong());
  CHECK(source_verdict(study, record) == Verdict::wrong);
}

TEST_CASE("scenario verdict: with both faults on a CV either source is right") {
  ExperimentRecord record = scenario();
  record.draw.disturbances.front().cv = 0;
  for (const ExperimentKind source : {ExperimentKind::mpm, ExperimentKind::ud}) {
    flag(record, 0, source);
    CHECK(scenario_verdict(record).right());
    CHECK_FALSE(scenario_verdict(record).judged_source);
  }
}

TEST_CASE("scenario verdict: the study may say that no CV is affected") {
  ExperimentRecord record = scenario();
  record.draw.affected_cvs.emplace();
  CHECK(scenario_verdict(record).right());
  flag(record, 0, ExperimentKind::mpm);
  CHECK(scenario_verdict(record).false_alarms == Cvs{0});
}

TEST_CASE("simulation errors: norms of rows, whatever the signals have in common") {
  Eigen::MatrixXd y(2, 3), y_sim(2, 3);
  y << 1, 2, 3, 7, 7, 7;
  y_sim << 4, 2, 7, 7, 7, 7;
  CHECK(simulation_errors(y, y_sim) == Eigen::Vector2d(5, 0));
  CHECK(simulation_errors(y.array() + 9, y_sim.array() + 9) == Eigen::Vector2d(5, 0));
  CHECK_THROWS_AS(simulation_errors(y, y_sim.leftCols(2)), InputError);

  Diagnosis diagnosis;
  CHECK(std::isnan(total_simulation_error(diagnosis)));
  diagnosis.cvs.resize(2);
  diagnosis.cvs[0].sse = 5;
  diagnosis.cvs[1].sse = 0.5;
  CHECK(total_simulation_error(diagnosis) == 5.5);
}

TEST_CASE("a scenario has the diagnosis of the same experiment drawn at random, and one of every CV") {
  Study study = find_study("chapter6");
  study.simulation.samples = 300;
  study.s0_perturbation = {};
  const QpSolverFactory factory = qp_solver_factory("active-set");
  const BasisCase basis = run_basis_case(study, factory);
  std::int64_t index = 0;
  while (draw_experiment(study, index).kind != ExperimentKind::mpm_ud)
    ++index;
  const ExperimentRecord random = ExperimentRunner(study, basis, factory).run(index, StorePolicy::all);
  REQUIRE(random.status == ExperimentStatus::ok);

  Study named = study;
  named.scenarios.resize(static_cast<std::size_t>(index) + 1);
  named.scenarios.back().mismatches = random.draw.mismatches;
  named.scenarios.back().disturbances = random.draw.disturbances;
  const ExperimentRecord same = ExperimentRunner(named, basis, factory).run(index, StorePolicy::all);
  CHECK(same.diagnosis.ivar == random.diagnosis.ivar);
  CHECK(same.diagnosis.ivar_diag == random.diagnosis.ivar_diag);
  CHECK(same.dominance_mpm == random.dominance_mpm);
  CHECK(random.diagnosis.cvs.empty());
  REQUIRE(same.diagnosis.cvs.size() == 7);
  const auto located = static_cast<std::size_t>(random.diagnosis.predicted_cv);
  CHECK(same.diagnosis.cvs[located].distribution.mpm.i_mpm == random.diagnosis.indicator.i_mpm);
  for (Eigen::Index cv = 0; cv < 7; ++cv) {
    const CvDiagnosis& found = same.diagnosis.cvs[static_cast<std::size_t>(cv)];
    CHECK(found.flagged == study.diagnosis.has_impact(random.diagnosis.ivar_diag(cv)));
    CHECK(found.sse == Approx((random.loop->y_sim - random.loop->trajectory.y).row(cv).norm()));
    CHECK((found.source == ExperimentKind::none) == !found.flagged);
  }

  named.scenarios.front() = {};  // healthy: nothing to find, and nothing is wrong with noise alone
  const ExperimentRecord healthy = ExperimentRunner(named, basis, factory).run(0, StorePolicy::none);
  CHECK(healthy.draw.kind == ExperimentKind::none);
  CHECK_FALSE(healthy.wrong());
  CHECK(std::isnan(healthy.dominance_mpm));
}

}  // namespace
