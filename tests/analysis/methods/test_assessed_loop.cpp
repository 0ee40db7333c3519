#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What a method of assessment gets to see of a loop, and when it is asked at all.

namespace mpm {
namespace {

using Catch::Contains;

/// The range MPC of chapter 6 without noise.
Study quiet_study() {
  Study study = find_study("chapter6");
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.samples = 120;
  return study;
}

AssessedLoop healthy_loop(const Study& study, const OperatingPoint& point) {
  return assessed_loop(study, point, simulate_experiment(study, {}, testing::kFactory));
}

/// A loop of two CVs and one MV, as awkward as a test wants it.
AssessedLoop made_up_loop() {
  AssessedLoop loop;
  loop.y = loop.y_sim = Eigen::MatrixXd::Zero(2, 5);
  loop.u = loop.u_target = Eigen::MatrixXd::Zero(1, 5);
  loop.d = Eigen::MatrixXd::Zero(0, 5);
  loop.y_set = Eigen::MatrixXd::Constant(2, 5, std::nan(""));
  return loop;
}

/// Counts how often it was made and asked.
struct Tally {
  int made = 0, asked = 0;
};

class CountingMethod final : public AssessmentMethod {
 public:
  explicit CountingMethod(Tally& tally) : tally_(tally) { ++tally_.made; }
  Assessment assess(const AssessedLoop&) override {
    ++tally_.asked;
    Assessment assessment;
    assessment.flagged = true;
    assessment.score = 2.0;
    return assessment;
  }

 private:
  Tally& tally_;
};

/// The records of a loop from sample `first` on, as a file of them has them.
PlantRecord record_of(const Trajectory& loop, Eigen::Index first) {
  const Eigen::Index samples = loop.y.cols() - first;
  const auto none = [&](Eigen::Index rows) { return Eigen::MatrixXd::Constant(rows, samples, kNaN); };
  return {.y = loop.y.rightCols(samples),
          .u = loop.u.rightCols(samples),
          .d = loop.d.rightCols(samples),
          .u_target = loop.u_target.rightCols(samples),
          .y_set = none(loop.y.rows()),
          .lower = none(loop.y.rows()),
          .upper = none(loop.y.rows()),
          .y_sim = none(loop.y.rows()),
          .candidates = none(0),
          .candidate_names = {},
          .stamps = {},
          .warnings = {}};
}

}  // namespace

TEST_CASE("a record that begins at rest is the loop that it was made of", "[assessed_loop]") {
  const Study study = quiet_study();
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory trajectory = simulate_experiment(study, {}, testing::kFactory);
  const AssessedLoop loop = assessed_loop(study, point, trajectory);
  const PlantRecord record = record_of(trajectory, 0);
  CHECK(samples_to_settle(study, point, record, RecordStart::automatic) == 0);
  const AssessedLoop recorded = assessed_loop(study, point, record, 0);
  CHECK(recorded.y == loop.y);
  CHECK(recorded.u_target == loop.u_target);
  CHECK(recorded.y_sim == loop.y_sim);
}

TEST_CASE("a record that begins anywhere is judged once the model has forgotten what was before",
          "[assessed_loop]") {
  Study study = quiet_study();
  study.simulation.samples = 400;
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory trajectory = simulate_experiment(study, {}, testing::kFactory);
  const PlantRecord record = record_of(trajectory, 130);  // within the answer to a step of a disturbance
  const Eigen::Index unjudged = samples_to_settle(study, point, record, RecordStart::anywhere);
  // 28 min and three times 60 min of y7/u1, the slowest channel, in samples of 4 min
  CHECK(unjudged == 52);
  const AssessedLoop recorded = assessed_loop(study, point, record, unjudged);
  CHECK(recorded.y.leftCols(unjudged).array().isNaN().all());
  CHECK_FALSE(recorded.y.rightCols(recorded.samples() - unjudged).hasNaN());
  const Eigen::MatrixXd off = (recorded.y_sim - trajectory.y.rightCols(recorded.samples())).cwiseAbs();
  // At the end of its settling time e^-3 is left in a first-order channel of what its input did before.
  const Eigen::Index first = 130;
  Eigen::MatrixXd inputs(trajectory.u.rows() + trajectory.d.rows(), first);
  inputs << trajectory.u.leftCols(first), trajectory.d.leftCols(first);
  Eigen::VectorXd start(inputs.rows());
  start << record.u.col(0), record.d.col(0);
  const Eigen::VectorXd moved = (inputs.colwise() - start).cwiseAbs().rowwise().maxCoeff();
  for (Eigen::Index cv = 0; cv < recorded.y.rows(); ++cv) {
    double memory = 0.0;
    for (Eigen::Index input = 0; input < moved.size(); ++input)
      memory += std::abs(study.plant.G(cv, input).static_gain()) * moved(input);
    CHECK(off.row(cv).rightCols(recorded.samples() - unjudged).maxCoeff() <= std::exp(-3.0) * memory);
  }
}

TEST_CASE("y_sim that was recorded is taken, and a setpoint is that of the study", "[assessed_loop]") {
  const Study study = find_study("setpoint-methods");
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory trajectory = simulate_experiment(study, {}, testing::kFactory);
  PlantRecord record = record_of(trajectory, 0);
  record.y_sim.row(1).setConstant(0.25);
  const AssessedLoop loop = assessed_loop(study, point, record, 0);
  CHECK(loop.y_sim.row(1) == record.y_sim.row(1));
  CHECK(loop.y_sim.row(0) == assessed_loop(study, point, trajectory).y_sim.row(0));
  CHECK(loop.y_set == trajectory.y_set);
}

TEST_CASE("a CV in a range has the steady state of the optimizer as setpoint: the soft limit it is put at",
          "[assessed_loop]") {
  Study study = quiet_study();
  study.assessment.setpoints = AssessmentSetpoints::optimizer;
  study.simulation.steps.clear();
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const AssessedLoop loop = healthy_loop(study, point);
  const Limits& soft = study.controller.cv_soft;
  REQUIRE(point.active.size() == 3);  // y1, y2 and y7
  for (const ActiveConstraint& active : point.active) {
    const double limit =
        active.kind == ConstraintKind::upper_limit ? soft.upper(active.cv) : soft.lower(active.cv);
    INFO("CV " << active.cv);
    // The tolerance of the optimizer, with static gains up to 7.
    CHECK((loop.y_set.row(active.cv).array() - limit).abs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("without noise the optimizer keeps all setpoints within the soft limits, also when an MD moves",
          "[assessed_loop]") {
  Study study = quiet_study();
  study.assessment.setpoints = AssessmentSetpoints::optimizer;
  const AssessedLoop loop = healthy_loop(study, operating_point(study, testing::kFactory));
  const Limits& soft = study.controller.cv_soft;
  for (Eigen::Index k = 0; k < loop.samples(); ++k) {
    CHECK((loop.y_set.col(k) - soft.upper).maxCoeff() < 1e-6);
    CHECK((soft.lower - loop.y_set.col(k)).maxCoeff() < 1e-6);
  }
  CHECK(loop.setpoint_cvs().size() == 7);
  // The limits of other CVs take over when d1 and d2 step: some setpoint must have moved.
  CHECK((loop.y_set.rightCols(1) - loop.y_set.leftCols(1)).cwiseAbs().maxCoeff() > 0.01);
}

TEST_CASE("a CV in a range has no setpoint unless the study wants one", "[assessed_loop]") {
  const Study study = quiet_study();
  REQUIRE(study.assessment.setpoints == AssessmentSetpoints::controller);
  const AssessedLoop loop = healthy_loop(study, operating_point(study, testing::kFactory));
  CHECK(loop.y_set.array().isNaN().all());
  CHECK(loop.setpoint_cvs().empty());
  // The model is the plant, and there is no noise: the simulated output is the measured one.
  CHECK((loop.y - loop.y_sim).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("a CV with a setpoint has that one, a CV in a range beside it has none", "[assessed_loop]") {
  Study study = find_study("wood-berry-mixed");
  study.simulation.samples = 60;
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory record = simulate_experiment(study, {}, testing::kFactory);
  const AssessedLoop loop = assessed_loop(study, point, record);
  int with = 0, without = 0;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    CHECK(loop.has_setpoint(cv) == study.controller.has_setpoint(cv));
    ++(loop.has_setpoint(cv) ? with : without);
    if (loop.has_setpoint(cv))
      CHECK(loop.y_set.row(cv) == record.y_set.row(cv));
  }
  CHECK(with > 0);
  CHECK(without > 0);
}

TEST_CASE("what a method needs and the loop does not have is said in one sentence", "[assessed_loop]") {
  const Study study = quiet_study();
  const BasisCase basis;
  const AssessmentContext context{study, basis, testing::kFactory, {}};
  AssessedLoop loop = made_up_loop();
  const auto unmet = [&](const AssessmentRequirements& needs) {
    return unmet_requirement(needs, context, loop).value_or("met");
  };
  CHECK(unmet({}) == "met");
  CHECK_THAT(unmet({.setpoints = true}),
             Contains("needs setpoints, and the controller holds every CV in a range"));
  CHECK_THAT(unmet({.moving_setpoints = true}), Contains("every CV in a range"));
  CHECK_THAT(unmet({.benchmark = true}), Contains("benchmark"));
  CHECK_THAT(unmet({.moving_mvs = true}), Contains("MVs that move"));

  loop.y_set.row(1).setConstant(0.3);
  CHECK(unmet({.setpoints = true}) == "met");
  CHECK_THAT(unmet({.moving_setpoints = true}), Contains("setpoints that move"));
  loop.y_set(1, 4) = 0.4;
  CHECK(unmet({.moving_setpoints = true}) == "met");
  loop.u(0, 2) = 1e-9;
  CHECK(unmet({.moving_mvs = true}) == "met");
  const AssessmentContext with_benchmark{study, basis, testing::kFactory, loop};
  CHECK_FALSE(unmet_requirement({.benchmark = true}, with_benchmark, loop));
}

TEST_CASE("a method is made for the first loop to which it applies, and once", "[assessed_loop]") {
  const Study study = quiet_study();
  const BasisCase basis;
  const AssessmentContext context{study, basis, testing::kFactory, {}};
  Tally tally;
  AssessmentMethodInfo info;
  info.requirements.moving_mvs = true;
  info.make = [&](const AssessmentContext&) { return std::make_unique<CountingMethod>(tally); };
  Assessor assessor(info, context);

  AssessedLoop loop = made_up_loop();
  const Assessment refused = assessor.assess(loop);
  CHECK(refused.status == AssessmentStatus::not_applicable);
  CHECK_THAT(refused.reason, Contains("MVs that move"));
  CHECK_FALSE(refused.flagged);
  CHECK(tally.made == 0);

  loop.u(0, 3) = 1.0;
  for (int i = 0; i < 3; ++i)
    CHECK(assessor.assess(loop).flagged);
  CHECK(tally.made == 1);
  CHECK(tally.asked == 3);
}

TEST_CASE("a loop that a method refuses has failed, with what it refused, and the next one is assessed",
          "[assessed_loop]") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const AssessedLoop& healthy = *context.benchmark;
  AssessedLoop odd = healthy;
  odd.y(2, 7) = std::numeric_limits<double>::infinity();
  for (const AssessmentMethodInfo& method : shipped_methods().methods()) {
    INFO(method.name);
    Assessor assessor(method, context);
    const Assessment refused = assessor.assess(odd);
    CHECK(refused.status != AssessmentStatus::ok);
    CHECK_FALSE(refused.flagged);
    CHECK_FALSE(refused.reason.empty());
    if (method.name == "botelho")
      CHECK(refused.status == AssessmentStatus::failed);
    CHECK(assessor.assess(healthy).status == Assessor(method, context).assess(healthy).status);
  }
}

TEST_CASE("a stored loop that did not reach its end gives no verdict, whatever the method",
          "[assessed_loop]") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"botelho", "sse"}, testing::kFactory);
  ExperimentRecord record = runner.run(0, StorePolicy::all);
  record.loop->trajectory.status = ControlStatus::infeasible;
  const std::vector<AssessmentRecord> assessments = runner.assess(record);
  REQUIRE(assessments.size() == 2);
  for (const AssessmentRecord& said : assessments) {
    CHECK(said.status == AssessmentStatus::failed);
    CHECK_FALSE(said.flagged);
    CHECK_THAT(said.reason, Contains("does not run to its end"));
  }
}

TEST_CASE("a panel has its methods in the order in which they are named, and no others", "[assessed_loop]") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"sse", "botelho"});
  REQUIRE(panel.forms().size() == 2);
  const AssessedLoop loop = assessed_loop(study, basis.point, basis.trajectory);
  const std::vector<AssessmentRecord> said = panel.assess(loop);
  for (std::size_t method = 0; method < 2; ++method) {
    CHECK(said[method].form == panel.forms()[method]);
    CHECK(panel.assess_by(panel.forms()[method]->method().name, loop)->score == said[method].score);
    CHECK(unassessed(panel.forms())[method].form == panel.forms()[method]);
    CHECK(unassessed(panel.forms())[method].status == AssessmentStatus::not_assessed);
  }
  CHECK(said[0].form->method().name == "sse");
  CHECK_FALSE(panel.assess_by("sun", loop));
  CHECK_THROWS_WITH(MethodPanel(study, assessment_context(study, basis, testing::kFactory), {"nobody"}),
                    Contains("found 'nobody'; allowed: botelho"));
}

namespace {

/// The column with noise, its bottom product measured by an analyser: every 4 samples, 2 samples late.
Study analysed_column() {
  Study study = find_study("wood-berry");
  study.controller.analysers = {{}, {4, 2}};
  return study;
}

}  // namespace

TEST_CASE("analyses stand where the stream was sampled, in a loop and in the record of it", "[analyser]") {
  Study study = analysed_column();
  study.simulation.noise_standard_deviation.setZero();
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory trajectory = simulate_experiment(study, {}, testing::kFactory);
  const AssessedLoop loop = assessed_loop(study, point, trajectory);
  CHECK_FALSE(loop.y.row(0).hasNaN());
  for (Eigen::Index k = 0; k + 2 < loop.samples(); ++k) {
    REQUIRE(std::isnan(loop.y(1, k)) == (k % 4 != 0));
    if (k % 4 == 0)  // the model is exact
      CHECK(loop.y(1, k) == Approx(loop.y_sim(1, k)).margin(1e-9));
  }
  // A record that begins 5 samples later does not say when the analyser takes its samples: it shows it.
  const AssessedLoop recorded = assessed_loop(study, point, record_of(trajectory, 5), 0);
  for (Eigen::Index k = 0; k + 2 < recorded.samples(); ++k) {
    REQUIRE(std::isnan(recorded.y(1, k)) == ((k + 5) % 4 != 0));
    if ((k + 5) % 4 == 0)
      CHECK(recorded.y(1, k) == loop.y(1, k + 5));
  }
}

TEST_CASE("an MD that is measured late stands where it acted, in a loop and in the record of it",
          "[analyser]") {
  Study study = find_study("wood-berry");
  study.simulation.noise_standard_deviation.setZero();
  study.controller.md_analysers = {{1, 6}};  // later than the feed reaches the bottom product
  const OperatingPoint point = operating_point(study, testing::kFactory);
  const Trajectory trajectory = simulate_experiment(study, {}, testing::kFactory);
  const AssessedLoop loop = assessed_loop(study, point, trajectory);
  const Eigen::Index known = loop.samples() - 6;
  CHECK(loop.d.leftCols(known) == measured_disturbances(study).leftCols(known));
  CHECK(trajectory.d.rightCols(known) == loop.d.leftCols(known));
  CHECK((loop.y - loop.y_sim).leftCols(known).cwiseAbs().maxCoeff() < 1e-9);  // the model is exact
  const AssessedLoop recorded = assessed_loop(study, point, record_of(trajectory, 0), 0);
  CHECK(recorded.d == loop.d);
  CHECK((recorded.y_sim - loop.y_sim).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a method that needs every sample gets analyses held, others what is there", "[analyser]") {
  const Study study = analysed_column();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const AssessedLoop& healthy = *context.benchmark;
  REQUIRE(healthy.y.row(1).hasNaN());
  const AssessedLoop held = *with_analyses_held(study, healthy, AnalysesHeld::from_taken);
  CHECK(held.y.row(0) == healthy.y.row(0));
  for (Eigen::Index k = 0; k + 6 < held.samples(); ++k) {
    CHECK(held.y(1, k) == healthy.y(1, k / 4 * 4));
    CHECK(held.y_sim(1, k) == healthy.y_sim(1, k / 4 * 4));
  }
  AssessedLoop gap = healthy;
  gap.y(1, 40) = kNaN;  // an analysis that is missing is not replaced by the one before it
  const AssessedLoop with_gap = *with_analyses_held(study, gap, AnalysesHeld::from_taken);
  CHECK(with_gap.y.row(1).segment(40, 4).array().isNaN().all());
  CHECK(with_gap.y.row(1).array().isNaN().count() == 4);
  const AssessedLoop shown = *with_analyses_held(study, healthy, AnalysesHeld::from_shown);
  const Eigen::Index samples = healthy.samples();
  CHECK(shown.y.rightCols(samples - 2) == basis.trajectory.y.rightCols(samples - 2));
  for (const char* name : {"botelho", "arx-oe", "sse", "likelihood", "variance-ratio"}) {
    const Assessment said = Assessor(assessment_method(name), context).assess(healthy);
    INFO(name << ": " << said.reason);
    CHECK(said.status == AssessmentStatus::ok);
  }
}

}  // namespace mpm
