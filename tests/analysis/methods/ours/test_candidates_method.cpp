#include <cmath>
#include <cstdint>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/candidates.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

constexpr int kCandidates = 5;

Study logging_study(const std::string& share) {
  return parse_study(
      find_study("setpoint-methods").source + "\n[record.candidates]\ncount = 5\nshare = " + share + "\n",
      "test");
}

}  // namespace

TEST_CASE(
    "logged candidates: the cause is among them in the share that is asked for, and no loop is another") {
  const Study study = logging_study("0.5");
  const Study plain = find_study("setpoint-methods");
  int disturbed = 0, logged = 0;
  for (std::int64_t index = 0; index < 400; ++index) {
    const ExperimentDraw draw = draw_experiment(study, index);
    const Eigen::Index cause = true_candidate(study, draw);
    if (draw.disturbances.empty()) {
      CHECK(cause == -1);
      continue;
    }
    ++disturbed;
    logged += cause >= 0 ? 1 : 0;
    if (cause < 0)
      continue;
    const Eigen::MatrixXd candidates = logged_candidates(study, draw);
    REQUIRE(candidates.rows() == kCandidates);
    const DisturbanceSignal& form = draw.disturbances.front().signal;
    const Eigen::RowVectorXd v = disturbance_signal(
        form, study.disturbance.v_standard_deviation, study.controller.sample_time, study.simulation.samples,
        experiment_stream(study, index, StreamId::disturbance_signal));
    for (Eigen::Index row = 0; row < kCandidates; ++row)
      CHECK((candidates.row(row) == v) == (row == cause));
  }
  REQUIRE(disturbed == 100);
  const Interval share = testing::clopper_pearson_interval(logged, disturbed, 0.999);
  CHECK((share.lower < 0.5 && share.upper > 0.5));
  const ExperimentDraw draw = draw_experiment(study, 1);
  CHECK(simulate_experiment(study, draw, testing::kFactory).y ==
        simulate_experiment(plain, draw_experiment(plain, 1), testing::kFactory).y);
  CHECK(logged_candidates(plain, draw).size() == 0);
  CHECK(true_candidate(plain, draw) == -1);
  for (const char* share_text : {"1.5", "-0.1"})
    CHECK_THROWS_WITH(logging_study(share_text), Catch::Contains("record.candidates.share"));
}

TEST_CASE("candidates: the cause of a disturbance is named, decoys are not") {
  const Study study = logging_study("0.5");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"candidates"}, testing::kFactory);
  int with_cause = 0, named = 0, decoys = 0, flagged_decoys = 0;
  for (std::int64_t index = 0; index < 80; ++index) {
    const ExperimentRecord record = runner.run(index, StorePolicy::none);
    if (record.status != ExperimentStatus::ok)
      continue;
    const AssessmentRecord& said = record.assessments.front();
    REQUIRE(said.answered());
    const Eigen::Index cause = true_candidate(study, record.draw);
    if (cause < 0) {
      ++decoys;
      CHECK(judge(study, record, said).candidate == Correctness::not_judged);
      flagged_decoys += said.flagged ? 1 : 0;
      continue;
    }
    ++with_cause;
    const bool right = said.flagged && said.predicted_cv == record.draw.true_cv() &&
                       said.number("candidate", said.predicted_cv) == static_cast<double>(cause);
    named += right ? 1 : 0;
    // The rate of `compare` looks at the signal that is named for the loop, whatever its CV.
    const bool told = said.number("named_candidate") == static_cast<double>(cause);
    CHECK(judge(study, record, said).candidate == (!said.flagged ? Correctness::not_judged
                                                   : told        ? Correctness::right
                                                                 : Correctness::wrong));
    AssessmentRecord another = said;
    another.set_number("named_candidate", static_cast<double>((cause + 1) % kCandidates));
    CHECK((!said.flagged || judge(study, record, another).candidate == Correctness::wrong));
    CHECK((!said.flagged || said.predicted_source == FaultSource::ud));
  }
  INFO(named << " of " << with_cause << " causes, " << flagged_decoys << " of " << decoys << " without");
  REQUIRE(with_cause > 5);
  CHECK(named == with_cause);
  CHECK(testing::clopper_pearson_interval(flagged_decoys, decoys, 0.999).lower <= 0.01);
}

TEST_CASE("candidates: does not apply where no such signal is logged") {
  const Study study = find_study("setpoint-methods");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const Assessment none = Assessor(assessment_method("candidates"), context).assess(*context.benchmark);
  CHECK(none.status == AssessmentStatus::not_applicable);
  CHECK(none.reason == "no signal outside of the model is logged");
}

}  // namespace mpm
