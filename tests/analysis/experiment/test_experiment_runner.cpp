#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/same_members.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/solvers/active_set_factory.hpp"

// One pass: the loop is run once, and each method of the study says what it sees in it.

namespace mpm {
namespace {

/// The chapter 6 study with short records.
Study short_study() {
  Study study = find_study("chapter6");
  study.simulation.samples = 300;
  study.s0_perturbation = {};
  return study;
}

/// The first experiment of this kind from `index` on.
std::int64_t first_of(const Study& study, ExperimentKind kind, std::int64_t index = 0) {
  while (draw_experiment(study, index).kind != kind)
    ++index;
  return index;
}

/// All but the processor time, which is another one each time.
void check_same(const AssessmentRecord& a, const AssessmentRecord& b) {
  INFO(a.form->method().name << " and " << b.form->method().name);
  CHECK(a.form->method().name == b.form->method().name);
  CHECK(a.status == b.status);
  CHECK(a.reason == b.reason);
  CHECK(a.flagged == b.flagged);
  CHECK(same(a.score, b.score));
  CHECK(a.predicted_cv == b.predicted_cv);
  CHECK(a.predicted_source == b.predicted_source);
  REQUIRE(a.numbers.size() == b.numbers.size());
  for (Eigen::Index i = 0; i < a.numbers.size(); ++i)
    REQUIRE(same(a.numbers(i), b.numbers(i)));
}

void check_same(const std::vector<AssessmentRecord>& a, const std::vector<AssessmentRecord>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t method = 0; method < a.size(); ++method)
    check_same(a[method], b[method]);
}

}  // namespace

TEST_CASE("runner: a loop is run once however many methods look at it, and none depends on the others",
          "[experiment_runner]") {
  const Study study = short_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const std::vector<std::string> all = shipped_methods().names();
  // With both faults there are three loops.
  const std::int64_t index = first_of(study, ExperimentKind::mpm_ud);
  std::int64_t steps = 0;
  const auto counted = [&](const std::vector<std::string>& methods) {
    steps = 0;
    return ExperimentRunner(study, basis, methods, testing::kFactory)
        .run(index, StorePolicy::none, [&](const Controller&) { ++steps; });
  };
  const ExperimentRecord by_all = counted(all);
  REQUIRE(by_all.status == ExperimentStatus::ok);
  CHECK(steps == 3 * study.simulation.samples);
  CHECK(steps == by_all.solver.steps);
  REQUIRE(by_all.assessments.size() == all.size());
  for (std::size_t method = 0; method < all.size(); ++method) {
    const ExperimentRecord alone = counted({all[method]});
    CHECK(steps == 3 * study.simulation.samples);
    CHECK(alone.status == ExperimentStatus::ok);
    CHECK(alone.ivar_basis == by_all.ivar_basis);
    REQUIRE(alone.assessments.size() == 1);
    check_same(alone.assessments[0], by_all.assessments[method]);
    CHECK(by_all.by(all[method]) == &by_all.assessments[method]);
    CHECK((by_all.assessments[method].milliseconds >= 0.0));
  }
  CHECK(by_all.by("nobody") == nullptr);
}

TEST_CASE("runner: what methods say afterwards, of a loop kept or run again, is what they said in the run",
          "[experiment_runner]") {
  Study study = short_study();
  study.experiments = {.mpm = 1, .ud = 0, .mpm_ud = 1, .healthy = 0, .tuning = 1};
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"sse", "botelho", "sun"}, testing::kFactory);
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::mpm_ud, ExperimentKind::tuning}) {
    INFO(to_string(kind));
    std::int64_t index = first_of(study, kind);
    ExperimentRecord record = runner.run(index, StorePolicy::all);
    while (record.status != ExperimentStatus::ok)
      record = runner.run(index = first_of(study, kind, index + 1), StorePolicy::all);
    REQUIRE(record.loop);
    check_same(runner.assess(record), record.assessments);
    // What runs loops: another S0, and faults alone of which the chain has to say something.
    CHECK(runner.runs_loops(record) == (kind != ExperimentKind::mpm));
    CHECK(ExperimentRunner(study, basis, {"sse"}, testing::kFactory).runs_loops(record) ==
          (kind == ExperimentKind::tuning));
    record.loop.reset();
    CHECK(runner.runs_loops(record));
    check_same(runner.assess(record), record.assessments);
    const double dominance = record.chain().number("dominance_mpm");
    CHECK(std::isnan(dominance) == (kind != ExperimentKind::mpm_ud));
  }
}

TEST_CASE("runner: what only a simulation knows of a loop adds up to it, and is kept when asked for",
          "[experiment_runner]") {
  const Study study = short_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"sse"}, testing::kFactory);
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud}) {
    INFO(to_string(kind));
    std::int64_t index = first_of(study, kind);
    ExperimentRecord record = runner.run(index, StorePolicy::truth);
    while (record.status != ExperimentStatus::ok)
      record = runner.run(index = first_of(study, kind, index + 1), StorePolicy::truth);
    REQUIRE(record.truth);
    CHECK_FALSE(runner.run(index, StorePolicy::all).truth);
    const Trajectory& loop = record.loop->trajectory;
    const Eigen::MatrixXd plant =
        simulated_output(with_mismatches(study.plant.G, record.draw.mismatches), study.controller.sample_time,
                         basis.point.u, loop.u, loop.d);
    CHECK((loop.y - record.truth->v - record.truth->y_d - plant).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((record.truth->y_d.cwiseAbs().maxCoeff() > 0.0) == (kind != ExperimentKind::mpm));
    CHECK(record.truth->v.cwiseAbs().maxCoeff() > 0.0);
    const auto check_alone = [&](const LoopTruth::Alone& alone, const ExperimentDraw& draw) {
      if (kind != ExperimentKind::mpm_ud) {
        CHECK(alone.y.size() == 0);
        return;
      }
      const Trajectory again = simulate_experiment(study, draw, testing::kFactory);
      CHECK(alone.y == again.y);
      CHECK(alone.u == again.u);
      CHECK(alone.y != loop.y);
    };
    check_alone(record.truth->mpm_alone, record.draw.mismatch_alone());
    check_alone(record.truth->ud_alone, record.draw.disturbance_alone());
  }
}

TEST_CASE("runner: the truth is there without the chain, and the chain says nothing that was not asked",
          "[experiment_runner]") {
  const Study study = short_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const std::int64_t index = first_of(study, ExperimentKind::mpm_ud);
  const ExperimentRecord record =
      ExperimentRunner(study, basis, {"sse"}, testing::kFactory).run(index, StorePolicy::none);
  REQUIRE(record.status == ExperimentStatus::ok);
  const Trajectory loop = simulate_experiment(study, record.draw, testing::kFactory);
  CHECK(record.ivar_basis == basis_variance_indices(study, loop.y, basis.trajectory.y));
  CHECK(record.by("botelho") == nullptr);
  CHECK(record.chain().values("ivar").size() == 0);
  CHECK(record.chain().predicted_cv == -1);
}

TEST_CASE("runner: of an infeasible experiment nobody is asked", "[experiment_runner]") {
  Study study = short_study();
  study.controller.cv_hard.lower *= 0.5;
  study.controller.cv_hard.upper *= 0.5;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  REQUIRE(basis.trajectory.status == ControlStatus::ok);
  ExperimentRunner runner(study, basis, {"botelho", "sse"}, testing::kFactory);
  std::int64_t index = 0;
  ExperimentRecord record = runner.run(index, StorePolicy::none);
  while (record.status != ExperimentStatus::infeasible)
    record = runner.run(++index, StorePolicy::none);
  REQUIRE(record.assessments.size() == 2);
  for (const AssessmentRecord& said : record.assessments) {
    CHECK(said.status == AssessmentStatus::not_assessed);
    CHECK(said.numbers.size() == 0);
    CHECK(said.reason.empty());
  }
  CHECK(record.ivar_basis.size() == 0);
}

TEST_CASE("runner: the loops that are kept by their verdict are those that the first method judges wrongly",
          "[experiment_runner]") {
  const Study study = short_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  int kept = 0, dropped = 0;
  for (const std::vector<std::string>& methods :
       {std::vector<std::string>{"botelho", "sse"}, std::vector<std::string>{"sse", "botelho"}}) {
    ExperimentRunner runner(study, basis, methods, testing::kFactory);
    for (std::int64_t index = 0; index < 12; ++index) {
      const ExperimentRecord record = runner.run(index, StorePolicy::flagged);
      CHECK(record.loop.has_value() == judge(study, record, record.assessments[0]).wrong());
      ++(record.loop ? kept : dropped);
    }
  }
  CHECK((kept > 0 && dropped > 0));
}

TEST_CASE("a scenario has the diagnosis of the same experiment drawn at random, and one of every CV",
          "[experiment_runner]") {
  const Study study = short_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const std::int64_t index = first_of(study, ExperimentKind::mpm_ud);
  const ExperimentRecord drawn =
      ExperimentRunner(study, basis, {"botelho"}, testing::kFactory).run(index, StorePolicy::all);
  REQUIRE(drawn.status == ExperimentStatus::ok);

  Study named = study;
  named.scenarios.resize(static_cast<std::size_t>(index) + 1);
  named.scenarios.back().mismatches = drawn.draw.mismatches;
  named.scenarios.back().disturbances = drawn.draw.disturbances;
  ExperimentRunner named_runner(named, basis, {"botelho"}, testing::kFactory);
  const ExperimentRecord again = named_runner.run(index, StorePolicy::all);
  const Diagnosis of_random = testing::diagnosis_of(drawn.chain()),
                  of_named = testing::diagnosis_of(again.chain());
  CHECK(of_named.ivar == of_random.ivar);
  CHECK(of_named.ivar_diag == of_random.ivar_diag);
  CHECK(of_named.alone.dominance_mpm == of_random.alone.dominance_mpm);
  CHECK(of_random.alone.dominance_mpm ==
        of_random.alone.ivar_diag_mpm / (of_random.alone.ivar_diag_mpm + of_random.alone.ivar_diag_ud));
  CHECK(of_random.cvs.empty());
  REQUIRE(of_named.cvs.size() == 7);
  const auto located = static_cast<std::size_t>(of_random.predicted_cv);
  CHECK(of_named.cvs[located].distribution.mpm.i_mpm == of_random.indicator.i_mpm);
  for (Eigen::Index cv = 0; cv < 7; ++cv) {
    const CvDiagnosis& found = of_named.cvs[static_cast<std::size_t>(cv)];
    CHECK(found.flagged == study.diagnosis.has_impact(of_random.ivar_diag(cv)));
    CHECK(found.sse == Approx((drawn.loop->y_sim - drawn.loop->trajectory.y).row(cv).norm()));
    CHECK((found.source == FaultSource::none) == !found.flagged);
  }

  named.scenarios.front() = {};  // healthy: nothing to find, and nothing is wrong with noise alone
  const ExperimentRecord healthy =
      ExperimentRunner(named, basis, {"botelho"}, testing::kFactory).run(0, StorePolicy::none);
  CHECK(healthy.draw.kind == ExperimentKind::healthy);
  CHECK_FALSE(judge(named, healthy, healthy.assessments[0]).wrong());
  CHECK(std::isnan(healthy.chain().number("dominance_mpm")));
}

}  // namespace mpm
