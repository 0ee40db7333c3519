#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/indicators/loop_cost.hpp"
#include "analysis/methods/ours/cv_errors.hpp"
#include "analysis/methods/ours/fault_comparison.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/methods/ours/source_weights.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/channel_health.hpp"
#include "analysis/records/channel_information.hpp"
#include "analysis/records/column_lags.hpp"
#include "analysis/records/controller_check.hpp"
#include "analysis/records/cost_of_record.hpp"
#include "analysis/records/held_columns.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/model_habit.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/record_verdict.hpp"
#include "analysis/records/trial_record.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/records/verdict_evidence.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/validation/record_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/qp_solver_factory.hpp"

// A record of the plant is judged for what it is: of this controller, explained by the model or not.

namespace mpm {
namespace {

/// Every channel is off by this factor of its gain.
TransferMatrix with_gains(const TransferMatrix& G, double factor) {
  std::vector<Mismatch> errors;
  for (Eigen::Index cv = 0; cv < G.rows(); ++cv)
    for (Eigen::Index input = 0; input < G.cols(); ++input)
      errors.push_back({cv, input, MismatchParameter::gain, factor});
  return with_mismatches(G, errors);
}

/// A loop of wood-berry with noise on this plant, from sample `first` on; y_d (none: 0) disturbs its CVs.
PlantRecord recorded_loop(const Study& study, const TransferMatrix& plant, Eigen::Index first,
                          const Eigen::MatrixXd& y_d = {}) {
  LoopSignals signals = experiment_signals(study, basis_draw());
  if (y_d.size() > 0)
    signals.y_d = y_d;
  const Trajectory loop = run_closed_loop(study, plant, signals, qp_solver_factory("auto"));
  const Eigen::Index N = loop.y.cols() - first;
  PlantRecord record;
  record.y = loop.y.rightCols(N);
  record.u = loop.u.rightCols(N);
  record.d = loop.d.rightCols(N);
  record.u_target = Eigen::MatrixXd::Constant(record.u.rows(), N, kNaN);
  record.y_set = record.lower = record.upper = record.y_sim =
      Eigen::MatrixXd::Constant(record.y.rows(), N, kNaN);
  record.stamps.assign(static_cast<std::size_t>(N), "");
  return record;
}

RecordFrame frame_of(const PlantRecord& record, bool begins_at_rest, double model_error,
                     const std::string& study = "wood-berry", const std::string& method = "order") {
  RecordFrame frame;
  frame.as_kept = frame.closed = recorded_study(find_study(study), record, {method}, {});
  frame.as_kept.assessment.model = frame.closed.assessment.model = AssessmentModel::benchmark;
  frame.methods = {method};
  frame.factory = qp_solver_factory("auto");
  frame.basis = run_basis_case(frame.as_kept, frame.factory);
  frame.settling = slowest_settling(frame.as_kept);
  frame.unjudged = begins_at_rest ? 0 : frame.settling;
  frame.model_error = model_error;
  return frame;
}

/// Variance of the errors of a CV about 0, over that of the noise of the study.
double excess(const RecordFrame& frame, const PlantRecord& record, Eigen::Index cv) {
  const AssessedLoop loop = judged_loop(frame, record);
  const Eigen::ArrayXd e = (loop.y.row(cv) - loop.y_sim.row(cv)).transpose();
  const auto there = !e.isNaN();
  const double noise = frame.as_kept.simulation.noise_standard_deviation(cv);
  return there.select(e.square(), 0.0).sum() / there.cast<double>().sum() / (noise * noise);
}

double model_score(const RecordFrame& frame, const PlantRecord& record) {
  const AssessmentContext context = assessment_context(frame.as_kept, frame.basis, frame.factory);
  return model_check_method(frame.model_error).make(context)->assess(judged_loop(frame, record)).score;
}

TEST_CASE("a bias and an unknown past are no errors of the model", "[records]") {
  const Study study = find_study("wood-berry");
  PlantRecord record = recorded_loop(study, study.plant.G, 50);
  record.y.row(1).array() += 0.5 * study.simulation.noise_standard_deviation(1);
  const RecordFrame exact = frame_of(record, false, 0.0), allowed = frame_of(record, false, 0.05);
  CHECK(excess(exact, record, 1) > 1.2);
  // Some 300 samples of white noise: a standard error of 8 %.
  CHECK(excess(allowed, record, 0) == Approx(1.0).epsilon(0.25));
  CHECK(excess(allowed, record, 1) == Approx(1.0).epsilon(0.25));
  CHECK(model_score(allowed, record) < 1.2);
}

TEST_CASE("what a record cannot tell is unknown beside a mismatch, not taken for a part of it", "[records]") {
  // The level remembers an hour behind its washout, so that the record's begin and its mean have a large part
  // of what a wrong flow does.
  const Study study = find_study("suite-evaporator");
  const TransferMatrix wrong = with_mismatches(study.plant.G, {{0, 0, MismatchParameter::gain, 0.5}});
  for (const Eigen::Index first : {60, 150}) {
    const PlantRecord record = recorded_loop(study, wrong, first);
    const RecordFrame frame = frame_of(record, false, 0.05, "suite-evaporator", "likelihood");
    const AssessmentRecord said = RecordPanel(frame).judge(record).said.front();
    INFO("from sample " << first);
    CHECK(said.flagged);
    CHECK(said.predicted_cv == 0);
    CHECK(said.predicted_source == FaultSource::mpm);
    const PlantRecord healthy = recorded_loop(study, study.plant.G, first);
    CHECK_FALSE(RecordPanel(frame).judge(healthy).said.front().flagged);
  }
}

TEST_CASE("the methods of a record answer in their order, and as each alone", "[records]") {
  const Study study = find_study("wood-berry");
  PlantRecord record = recorded_loop(study, study.plant.G, 0);
  record.y.block(0, 100, 2, 3).setConstant(kNaN);
  // `sse` needs every sample, the others do not.
  const std::vector<std::string> names{"order", "sse", "likelihood", "excitation"};
  for (const std::pair<Eigen::Index, Eigen::Index> benchmark : {std::pair{0, 0}, std::pair{20, 180}}) {
    record.benchmark = benchmark;
    RecordFrame all = frame_of(record, true, 0.05);
    all.methods = names;
    all.fill = GapFill::linear;
    RecordPanel panel(all);
    for (int time = 0; time < 2; ++time) {
      const std::vector<AssessmentRecord> said = panel.judge(record).said;
      REQUIRE(said.size() == names.size());
      for (std::size_t m = 0; m < names.size(); ++m) {
        RecordFrame one = all;
        one.methods = {names[m]};
        const AssessmentRecord alone = RecordPanel(one).judge(record).said.front();
        INFO(names[m] << ": " << said[m].reason);
        CHECK(said[m].form->method().name == names[m]);
        REQUIRE(said[m].answered());
        CHECK(said[m].score == alone.score);
        CHECK(said[m].predicted_cv == alone.predicted_cv);
      }
    }
  }
}

TEST_CASE("errors of some percent explain a record, a wrong gain does not", "[records]") {
  const Study study = find_study("wood-berry");
  const PlantRecord healthy = recorded_loop(study, with_gains(study.plant.G, 1.04), 0);
  const TransferMatrix wrong = with_mismatches(study.plant.G, {{1, 1, MismatchParameter::gain, 1.5}});
  const PlantRecord faulty = recorded_loop(study, wrong, 0);
  CHECK(model_score(frame_of(healthy, true, 0.05), healthy) < 1.3);
  CHECK(model_score(frame_of(faulty, true, 0.05), faulty) > 2.0);
}

TEST_CASE("the controller of a record is known by its moves", "[records]") {
  const Study study = find_study("wood-berry");
  const PlantRecord own = recorded_loop(study, study.plant.G, 50);
  const RecordFrame frame = frame_of(own, false, 0.05);
  const ControllerCheck check = check_controller(frame, own, judged_loop(frame, own));
  CHECK(check.agreement.minCoeff() > 0.99);
  CHECK(check.is_alike());
  CHECK(check.is_closed_loop);

  SECTION("of an open-loop test the MVs answer no CV") {
    PlantRecord test = own;
    for (Eigen::Index k = 0; k < test.samples(); ++k)
      test.u.col(k) << (k / 60 % 2 == 0 ? 0.02 : -0.02), (k / 45 % 2 == 0 ? 0.015 : -0.015);
    const Eigen::MatrixXd noise = measurement_noise(study, 3).rightCols(test.samples());
    test.y = noise + simulated_output(study.plant.G, study.controller.sample_time, Eigen::VectorXd::Zero(2),
                                      test.u, test.d);
    const ControllerCheck said = check_controller(frame, test, judged_loop(frame, test));
    CHECK_FALSE(said.is_alike());
    CHECK_FALSE(said.is_closed_loop);
  }
}

/// wood-berry with an MV that an operator moves and a CV that is left alone.
Study switched_wood_berry() {
  Study study = find_study("wood-berry");
  study.simulation.off = {{VariableSort::mv, 0, 110, 50, 0.03},
                          {VariableSort::cv, 1, 130, 90, {}},
                          {VariableSort::mv, 0, 160, 40, -0.02}};
  return study;
}

/// Its record with the modes.
PlantRecord switched_record(const Study& study, const TransferMatrix& plant) {
  PlantRecord record = recorded_loop(study, plant, 50);
  record.u_off.setZero(2, record.samples());
  record.y_off.setZero(2, record.samples());
  record.u_off.row(0).segment(60, 90).setOnes();
  record.y_off.row(1).segment(80, 90).setOnes();
  return record;
}

TEST_CASE("with its modes a record is of its controller, without them it is not", "[records]") {
  const Study study = switched_wood_berry();
  const PlantRecord record = switched_record(study, study.plant.G);
  const RecordFrame frame = frame_of(record, false, 0.05);
  const std::vector<OffSpell> expected{{VariableSort::mv, 0, 60, 50, 0.03},
                                       {VariableSort::cv, 1, 80, 90, {}},
                                       {VariableSort::mv, 0, 110, 40, -0.02}};
  CHECK(frame.as_kept.simulation.off == expected);
  const ControllerCheck check = check_controller(frame, record, judged_loop(frame, record));
  CHECK(check.agreement.minCoeff() > 0.99);
  CHECK(check.is_alike());
  CHECK(model_score(frame, record) < 1.3);

  PlantRecord without = record;
  without.u_off = without.y_off = {};
  const RecordFrame blind = frame_of(without, false, 0.05);
  const ControllerCheck other = check_controller(blind, without, judged_loop(blind, without));
  INFO(other.agreement.transpose());
  CHECK_FALSE(other.is_alike());
}

TEST_CASE("simulated records have the MVs where operators held them, also before the record", "[records]") {
  const Study study = switched_wood_berry();
  const PlantRecord record = switched_record(study, study.plant.G);
  const PlantRecord longer = with_lead(record, 100);
  CHECK(longer.has_mv_off(0, 100 - 60));
  CHECK_FALSE(longer.has_mv_off(0, 100 - 59));
  CHECK(longer.has_cv_off(1, 180));
  const TrialFrame made{.record = record,
                        .study = trial_study(recorded_study(find_study("wood-berry"), longer, {"order"}, {}),
                                             {.healthy = 2, .faulty = 2, .model_error = 0.05}),
                        .lead = 100,
                        .bias = 0.0};
  const ExperimentDraw draw = draw_experiment(made.study, 0);
  const Trajectory loop = simulate_experiment(made.study, draw, qp_solver_factory("auto"));
  const PlantRecord trial = trial_record(made, draw, loop);
  CHECK(trial.u_off == record.u_off);
  CHECK(trial.u.row(0).segment(60, 90) == record.u.row(0).segment(60, 90));
  CHECK(loop.u(0, 40) == record.u(0, 60));
}

TEST_CASE("a column that is late is named, and no other", "[records]") {
  const Study study = find_study("wood-berry");
  const PlantRecord record = recorded_loop(study, study.plant.G, 0);
  const RecordFrame frame = frame_of(record, true, 0.05);
  CHECK(column_lags(frame, record).empty());
  PlantRecord late = record;
  late.u.row(1).tail(late.samples() - 2) = record.u.row(1).head(late.samples() - 2);
  const std::vector<std::string> said = column_lags(frame, late);
  REQUIRE(said.size() == 1);
  CHECK(said.front().starts_with("the column of S seems to be 2 samples too late"));
}

/// A loop whose first MV moves as `move` says, with the noise of the study and nothing else.
AssessedLoop moved_loop(const Study& study, const std::function<double(Eigen::Index)>& move) {
  const Eigen::MatrixXd noise = measurement_noise(study, 3);
  AssessedLoop loop;
  loop.u = Eigen::MatrixXd::Zero(study.mv_count(), noise.cols());
  for (Eigen::Index k = 0; k < noise.cols(); ++k)
    loop.u(0, k) = move(k);
  loop.d = Eigen::MatrixXd::Zero(study.md_count(), noise.cols());
  loop.y_sim = simulated_output(study.plant.G, study.controller.sample_time,
                                Eigen::VectorXd::Zero(study.mv_count()), loop.u, loop.d);
  loop.y = loop.y_sim + noise;
  loop.y.leftCols(2 * slowest_settling(study)).setConstant(kNaN);
  return loop;
}

TEST_CASE("one sine tells two numbers of a channel, steps tell three", "[records]") {
  const Study study = find_study("wood-berry");
  const AssessedLoop sine =
      moved_loop(study, [](Eigen::Index k) { return 0.1 * std::sin(0.2 * static_cast<double>(k)); });
  const ChannelInformation by_sine = channel_information(study, sine, {0, 0}, 0.05);
  CHECK(by_sine.parameters == 3);
  CHECK(by_sine.rank == 2);
  CHECK(by_sine.condition > 1e6);
  CHECK(by_sine.alike.size() >= 2);
  const AssessedLoop steps = moved_loop(study, [](Eigen::Index k) { return k / 40 % 2 == 0 ? 0.1 : -0.1; });
  const ChannelInformation by_steps = channel_information(study, steps, {0, 0}, 0.05);
  CHECK(by_steps.rank == 3);
  CHECK(by_steps.condition < 1000.0);
}

TEST_CASE("a record that begins in mid-movement near the operating point has a past", "[records]") {
  const Study study = find_study("wood-berry");
  const AssessedLoop whole = moved_loop(study, [](Eigen::Index k) { return k < 20 ? 0.0 : 0.1; });
  AssessedLoop loop = whole;
  loop.y = loop.y_sim + measurement_noise(study, 4);
  const Eigen::Index settling = slowest_settling(study);
  CHECK_FALSE(shows_a_past(loop, settling));
  loop.y.row(0).head(30).array() += 5.0 * study.simulation.noise_standard_deviation(0);
  CHECK(shows_a_past(loop, settling));
}

TEST_CASE("after a gap in all columns the memory of the model fills again", "[records]") {
  const Study study = find_study("wood-berry");
  PlantRecord record = recorded_loop(study, study.plant.G, 0);
  const RecordFrame frame = frame_of(record, true, 0.05);
  record.y.middleCols(100, 30).setConstant(kNaN);
  CHECK_FALSE(judged_loop(frame, record).y.col(130).hasNaN());  // the MVs are known
  for (Eigen::Index k = 100; k < 130; ++k) {
    record.u.col(k) = record.u.col(99);
    record.d.col(k) = record.d.col(99);
  }
  const AssessedLoop loop = judged_loop(frame, record);
  CHECK(loop.y.middleCols(100, 30 + frame.settling).array().isNaN().all());
  CHECK_FALSE(loop.y.col(130 + frame.settling).hasNaN());
}

TEST_CASE("a simulated record begins where the record does, with its gaps", "[records]") {
  const Study study = find_study("wood-berry");
  PlantRecord record = recorded_loop(study, study.plant.G, 0);
  record.y.row(0).segment(40, 5).setConstant(kNaN);
  const PlantRecord longer = with_lead(record, 60);
  CHECK(longer.samples() == record.samples() + 60);
  CHECK(longer.d.rightCols(record.samples()) == record.d);
  CHECK(longer.d.col(59) == record.d.col(1));
  TrialFrame made{.record = record, .study = {}, .lead = 60, .bias = kTrialBias};
  made.study = trial_study(recorded_study(study, longer, {"order"}, {}),
                           {.healthy = 2, .faulty = 2, .model_error = 0.05});
  REQUIRE(made.study.world);
  CHECK(made.study.world->count == 2);
  const ExperimentDraw draw = draw_experiment(made.study, 0);
  const Trajectory loop = simulate_experiment(made.study, draw, qp_solver_factory("auto"));
  const PlantRecord trial = trial_record(made, draw, loop);
  CHECK(trial.samples() == record.samples());
  CHECK(trial.y.row(0).segment(40, 5).array().isNaN().all());
  CHECK(trial.y.row(0).array().isNaN().count() == 5);
  const Eigen::RowVectorXd off = trial.y.row(1) - loop.y.row(1).tail(record.samples());
  CHECK((off.array() - off(0)).abs().maxCoeff() < 1e-12);  // rounding
  CHECK(std::abs(off(0)) <= kTrialBias * study.simulation.noise_standard_deviation(1));
}

/// wood-berry in closed loop with errors of 2 % in all gains, and what may be wrong with its record.
struct Suspect {
  Study study = find_study("wood-berry");
  PlantRecord record = recorded_loop(study, with_gains(study.plant.G, 1.02), 0);
  RecordFrame frame = frame_of(record, true, 0.05);

  Eigen::RowVectorXd response(Eigen::Index cv, Eigen::Index mv, const Eigen::RowVectorXd& x) const {
    return channel_response(discretise(study.plant.G(cv, mv), study.controller.sample_time), x, 0.0);
  }
  AssessedLoop loop() const { return judged_loop(frame, record); }
  static std::vector<CvErrors> errors(const RecordFrame& frame, const AssessedLoop& loop) {
    const ChannelErrorFits fits(frame.as_kept, 0.05);
    std::vector<CvErrors> all;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const ChannelErrorFit fit = fits.of(loop, cv);
      all.emplace_back(loop, cv, fit.samples, fit.e, fit.X);
    }
    return all;
  }
  FaultLikelihoods likelihoods() const {
    const AssessedLoop seen = loop();
    return FaultComparison(frame.as_kept, seen, errors(frame, seen)).likelihoods();
  }
  /// What the inputs tell beside a disturbance.
  double dependence() const {
    const AssessedLoop seen = loop();
    return FaultComparison(frame.as_kept, seen, errors(frame, seen))
        .dependence_beside(RecordSource::disturbance);
  }
  LateCvs lateness() const {
    const AssessedLoop seen = loop();
    std::vector<CvErrors> all = errors(frame, seen);
    for (CvErrors& each : all)
      each.find_change();
    return common_lateness(frame.as_kept, seen, all);
  }
};

TEST_CASE("a fault that begins within the record is dated, and none where nothing changes", "[records]") {
  const auto onset = [](const Suspect& suspect) {
    return fault_onset(ChannelErrorFits(suspect.frame.as_kept, 0.05).of(suspect.loop(), 0), 1.2);
  };
  CHECK_FALSE(onset(Suspect{}));
  Suspect throughout, later;
  throughout.record.y.row(0) += 0.6 * throughout.response(0, 0, throughout.record.u.row(0));
  CHECK_FALSE(onset(throughout));
  Eigen::RowVectorXd u = later.record.u.row(0);
  u.head(200).setZero();
  later.record.y.row(0) += 0.6 * later.response(0, 0, u);
  const auto found = onset(later);
  REQUIRE(found);
  CHECK(std::abs(found->sample - 200) < 40);  // as far as the MV moves next
  CHECK((found->earliest <= found->sample && found->sample <= found->latest));
}

TEST_CASE("columns of another clock are no error of the model, nor is a dead time another clock",
          "[records]") {
  const auto lateness = [](const Suspect& suspect) {
    const LateCvs late = suspect.lateness();
    CHECK(late.cvs.empty());
    return late.samples;
  };
  CHECK(lateness(Suspect{}) == 0.0);
  const Eigen::Index N = Suspect{}.record.samples();
  Suspect early, late, averages, slow;
  early.record.y.leftCols(N - 1) = Suspect{}.record.y.rightCols(N - 1);
  CHECK(lateness(early) == -1.0);
  late.record.y.rightCols(N - 1) = Suspect{}.record.y.leftCols(N - 1);
  CHECK(lateness(late) == 1.0);
  averages.record.y.leftCols(N - 1) =
      0.5 * (Suspect{}.record.y.leftCols(N - 1) + Suspect{}.record.y.rightCols(N - 1));
  CHECK(lateness(averages) == -0.5);
  const TransferMatrix slower =
      with_mismatches(slow.study.plant.G, {{0, 0, MismatchParameter::dead_time, 1.0}});
  slow.record = recorded_loop(slow.study, slower, 0);
  CHECK(lateness(slow) == 0.0);
  early.frame.late = {-1.0};
  CHECK(model_score(early.frame, early.record) < 1.2);
  Suspect one;
  one.record.y.row(0).head(N - 1) = Suspect{}.record.y.row(0).tail(N - 1);
  const LateCvs found = one.lateness();
  CHECK(found.samples == -1.0);
  CHECK(found.cvs == std::vector<Eigen::Index>{0});
  one.frame.late = found;
  CHECK(model_score(one.frame, one.record) < 1.2);
}

TEST_CASE("a drift is a sensor's, and steps of a valve are a valve's, whoever describes them", "[records]") {
  Suspect drift, biased, stays, disturbed;
  const Eigen::Index N = drift.record.samples();
  drift.record.y.row(1) += Eigen::RowVectorXd::LinSpaced(N, -0.05, 0.15).cwiseMax(0.0);
  const FaultLikelihoods drifts = drift.likelihoods();
  CHECK(drifts.sensor > std::max({drifts.disturbance, drifts.mismatch, drifts.valve, drifts.data}) + 5.0);
  CHECK((drifts.sensor_cv == 1 && !drifts.sensor_jumps));
  biased.record.y.row(1).tail(N / 3).array() += 0.15;
  const FaultLikelihoods jumps = biased.likelihoods();
  CHECK(jumps.sensor > std::max({jumps.disturbance, jumps.mismatch, jumps.valve, jumps.data}) + 5.0);
  CHECK((jumps.sensor_cv == 1 && jumps.sensor_jumps));
  double position = 0.0;
  Eigen::RowVectorXd x = stays.record.u.row(1);
  for (double& each : x)
    each = position = std::abs(each - position) > 0.012 ? each : position;
  for (Eigen::Index cv = 0; cv < 2; ++cv)
    stays.record.y.row(cv) += stays.response(cv, 1, x - stays.record.u.row(1));
  const FaultLikelihoods sticks = stays.likelihoods();
  // Ten times as probable as the others.
  CHECK(sticks.valve > std::max({sticks.disturbance, sticks.mismatch, sticks.sensor, sticks.data}) + 2.3);
  CHECK(sticks.valve_mv == 1);
  Eigen::RowVectorXd v = measurement_noise(disturbed.study, 5).row(0);
  for (Eigen::Index k = 1; k < N; ++k)
    v(k) = 0.95 * v(k - 1) + 2.0 * v(k);
  disturbed.record.y.row(0) += v;
  const FaultLikelihoods slow = disturbed.likelihoods();
  CHECK(std::max({slow.valve, slow.sensor, slow.data}) < slow.disturbance + 5.0);
}

TEST_CASE("a CV that is frozen does not look absolute", "[records]") {
  Suspect frozen, absolute;
  frozen.study.controller.cv_hard = absolute.study.controller.cv_hard = Limits::none(2);
  for (Eigen::Index k = 0; k < frozen.record.samples(); ++k)
    frozen.record.y(1, k) = 5.0 + std::sin(0.9 * static_cast<double>(k));
  absolute.record.y.row(1) = frozen.record.y.row(1).array() + 20.0;
  CHECK_NOTHROW(check_record(frozen.study, frozen.record));
  frozen.record.y.row(1).tail(frozen.record.samples() * 7 / 10).setConstant(5.0);
  CHECK_NOTHROW(check_record(frozen.study, frozen.record));
  CHECK_THROWS_AS(check_record(absolute.study, absolute.record), InputError);
}

TEST_CASE("a disturbance of an MV that begins within the record explains it, and a valve does not",
          "[records]") {
  Suspect disturbed, wrong;
  const Eigen::Index N = disturbed.record.samples();
  Eigen::RowVectorXd v = 3.0 * measurement_noise(disturbed.study, 5).row(0);
  v.head(N / 2).setZero();
  for (Eigen::Index k = 1; k < N; ++k)
    v(k) += 0.95 * v(k - 1);
  Eigen::MatrixXd y_d(2, N);
  y_d << disturbed.response(0, 0, v), disturbed.response(1, 0, v);
  disturbed.record = recorded_loop(disturbed.study, with_gains(disturbed.study.plant.G, 1.02), 0, y_d);
  const FaultLikelihoods found = disturbed.likelihoods();
  CHECK(found.disturbance > std::max({found.mismatch, found.valve, found.data}));
  CHECK(disturbed.dependence() < 1.0);
  wrong.record = recorded_loop(
      wrong.study, with_mismatches(wrong.study.plant.G, {{0, 0, MismatchParameter::gain, 1.8}}), 0);
  const FaultLikelihoods mismatch = wrong.likelihoods();
  CHECK(mismatch.mismatch > mismatch.disturbance + 20.0);
  REQUIRE(mismatch.named);
  CHECK(mismatch.named->channel == Channel{0, 0});
  CHECK(mismatch.named->parameter == MismatchParameter::gain);
}

TEST_CASE("what test signals move beyond the model is no disturbance", "[records]") {
  Suspect moved;
  Eigen::RowVectorXd test = measurement_noise(moved.study, 5).row(0);
  for (Eigen::Index k = 0; k < test.size(); ++k)
    test(k) = k % 7 > 0 ? test(k - 1) : test(k) > 0.0 ? 0.1 : -0.1;
  moved.record.u.row(0) += test;
  for (Eigen::Index cv = 0; cv < 2; ++cv)
    moved.record.y.row(cv) += moved.response(cv, 0, test);
  CHECK(moved.dependence() < 1.0);
  moved.record.y.row(0) += moved.response(0, 0, test);
  CHECK(moved.dependence() > 1.0);
}

TEST_CASE("a CV with hardly a value tells nothing of its noise", "[records]") {
  for (const Eigen::Index values : {2, 3, 6, 8}) {
    Suspect suspect;
    suspect.record.y.row(0).tail(suspect.record.samples() - values).setConstant(kNaN);
    const AssessedLoop loop = suspect.loop();
    CHECK(std::isnan(
        input_dependence(suspect.frame.as_kept, loop, Suspect::errors(suspect.frame, loop).front(), 0)));
    CHECK(std::isfinite(suspect.likelihoods().disturbance));
  }
}

TEST_CASE("what the likelihood is sure of is believed to 99 %", "[records]") {
  const auto weights_of = [](RecordSource sure, double mismatch) {
    OfSources weights;
    weights[sure] = 1.0;
    return with_comparison(
               weights,
               {.disturbance = 0.0, .mismatch = mismatch, .data = -9.0, .sensor = -9.0, .valve = -9.0})
        .of;
  };
  const OfSources overruled = weights_of(RecordSource::disturbance, 40.0);
  CHECK(overruled[RecordSource::mismatch] > overruled[RecordSource::disturbance]);
  const OfSources no_channel = weights_of(RecordSource::both, -8.0);
  CHECK(no_channel[RecordSource::disturbance] > no_channel[RecordSource::both]);
  const OfSources kept = weights_of(RecordSource::disturbance, 3.0);
  CHECK(kept[RecordSource::disturbance] > kept[RecordSource::mismatch]);
}

TEST_CASE("what leaves more than chance does is none of the faults, as far as simulated records go",
          "[records]") {
  OfSources weights;
  weights[RecordSource::disturbance] = 1.0;
  const SourceWeights found = with_comparison(
      weights, {.disturbance = 0.0, .mismatch = -8.0, .data = -9.0, .sensor = -9.0, .valve = -9.0});
  const auto is_unknown = [&found](double r) {
    const OfSources of = with_none_of_these(found, r).of;
    return of[RecordSource::unknown] > of[RecordSource::disturbance];
  };
  CHECK_FALSE(is_unknown(0.9));
  CHECK_FALSE(is_unknown(1.1));  // a little more than chance leaves
  CHECK(is_unknown(1.5));
}

/// Slow noise on both CVs that never stops, of this many standard deviations of their noise.
void add_background(Suspect& suspect, double size) {
  for (Eigen::Index cv = 0; cv < 2; ++cv) {
    Eigen::VectorXd v = size * measurement_noise(suspect.study, 5).row(cv).transpose();
    for (Eigen::Index k = 1; k < v.size(); ++k)
      v(k) += 0.95 * v(k - 1);
    suspect.record.y.row(cv) += v.transpose();
  }
}

TEST_CASE("what a plant did in its benchmark is its habit, and what is new is not", "[records]") {
  const auto score = [](const Suspect& suspect, Eigen::Index benchmark) {
    const AssessedLoop loop = suspect.loop();
    const auto habit =
        benchmark == 0 ? nullptr : habit_of(suspect.frame.as_kept, 0.05, window_of(loop, 0, benchmark));
    const ChannelErrorFit fit = ChannelErrorFits(suspect.frame.as_kept, 0.05, habit).of(loop, 0);
    return error_score(fit.a, fit.left, fit.noise);
  };
  Suspect restless, wrong, calm;
  add_background(restless, 2.0);
  CHECK(score(restless, 0) > 2.0);
  CHECK(score(restless, 150) < kFarTooLarge);
  add_background(wrong, 2.0);
  Eigen::RowVectorXd u = wrong.record.u.row(0);
  u.head(200).setConstant(u(0));
  wrong.record.y.row(0) += 2.0 * wrong.response(0, 0, u);
  CHECK(score(wrong, 150) > kFarTooLarge);
  CHECK(score(calm, 150) == Approx(score(calm, 0)).epsilon(0.2));
  // Noise that the benchmark has as well is no other noise than that of the plant.
  Suspect noisy;
  noisy.record.y.row(1) += 15.0 * measurement_noise(noisy.study, 6).row(1);
  const AssessedLoop loop = noisy.loop();
  CHECK(unexplained_cvs(noisy.frame.as_kept, loop, 0.05).size() == 1);
  const auto habit = habit_of(noisy.frame.as_kept, 0.05, window_of(loop, 0, 150));
  CHECK(unexplained_cvs(noisy.frame.as_kept, loop, 0.05, habit.get()).empty());
}

TEST_CASE("a channel that is wrong throughout is wrong in every benchmark", "[records]") {
  const auto channel_score = [](const Suspect& suspect) {
    const auto [first, end] = best_period(suspect.frame, suspect.loop());
    REQUIRE(end > first);
    const AssessedLoop loop = suspect.loop();
    return habit_of(suspect.frame.as_kept, 0.05, window_of(loop, first, end - first))
        ->noise[0]
        ->channel_score;
  };
  Suspect healthy, wrong;
  CHECK(channel_score(healthy) < kFarTooLarge);
  wrong.record.y.row(0) += wrong.response(0, 0, wrong.record.u.row(0));
  CHECK(channel_score(wrong) > kFarTooLarge);
}

TEST_CASE("a drift is a sensor's or a disturbance's, and the verdict says both", "[records]") {
  FaultLikelihoods alternatives{.disturbance = -100.0,
                                .mismatch = -110.0,
                                .data = -120.0,
                                .sensor = -80.0,
                                .valve = -120.0,
                                .sensor_cv = 1};
  OfSources weights;
  weights[RecordSource::disturbance] = 1.0;
  const SourceWeights found = with_comparison(weights, alternatives);
  CHECK(found.of[RecordSource::sensor] == Approx(found.of[RecordSource::disturbance]).epsilon(1e-6));
  VerdictEvidence evidence;
  evidence.model_scores = Eigen::Vector2d(9.0, 1.0);
  evidence.model_threshold = 1.2;
  evidence.weights = found;
  evidence.sensor_cv = 1;
  RecordVerdict verdict = record_verdict(evidence);
  CHECK(verdict.model.drifts);
  CHECK(verdict.action.kind == ActionKind::sensor);
  CHECK(verdict.action.cv == 1);
  alternatives.sensor = -100.0;  // no ramp explains more than slow noise does
  evidence.weights = with_comparison(weights, alternatives);
  verdict = record_verdict(evidence);
  CHECK_FALSE(verdict.model.drifts);
  CHECK(verdict.model.source == RecordSource::disturbance);
}

TEST_CASE("a CV that is held from one analysis to the next counts at its analyses only", "[records]") {
  const Study study = find_study("wood-berry");
  const PlantRecord measured = recorded_loop(study, study.plant.G, 0);
  const auto judged_with = [&study](PlantRecord& record) { return with_held_columns(study, record); };
  const auto held_by = [&measured](const std::function<bool(Eigen::Index)>& is_new) {
    PlantRecord record = measured;
    for (Eigen::Index k = 1; k < record.samples(); ++k)
      if (!is_new(k))
        record.y(1, k) = record.y(1, k - 1);
    return record;
  };
  PlantRecord record = measured;
  CHECK(judged_with(record).controller.analysers[1].period == 1);
  CHECK(record.warnings.empty());
  record = held_by([](Eigen::Index k) { return k % 4 == 0; });
  CHECK(judged_with(record).controller.analysers[1].period == 4);
  REQUIRE(record.warnings.size() == 1);
  CHECK(record.warnings.front().starts_with("xB has a new value every 4 samples only"));
  record = held_by([](Eigen::Index k) { return k % 7 == 0 || k % 5 == 0; });  // in no rhythm
  CHECK(judged_with(record).controller.analysers[1].period == 1);
  REQUIRE(record.warnings.size() == 1);
  CHECK(record.warnings.front().find("held values count as measured") != std::string::npos);
  record = measured;  // rounding repeats a value now and then
  const double unit = 2.0 * study.simulation.noise_standard_deviation(1);
  record.y.row(1) = unit * (record.y.row(1) / unit).array().round();
  CHECK(judged_with(record).controller.analysers[1].period == 1);
  CHECK(record.warnings.empty());
}

TEST_CASE("CVs that are late by the same have one clock", "[records]") {
  const Study study = find_study("wood-berry");
  PlantRecord record = recorded_loop(study, study.plant.G, 0);
  const RecordFrame frame = frame_of(record, true, 0.05);
  record.y.rightCols(record.samples() - 2) = Eigen::MatrixXd(record.y.leftCols(record.samples() - 2));
  const std::vector<std::string> said = column_lags(frame, record);
  REQUIRE(said.size() == 1);
  CHECK(said.front().starts_with("the columns of xD, xB seem to be 2 samples too late, all by the same"));
}

TEST_CASE("samples that do not count cost nothing in a repair", "[records]") {
  const Study study = find_study("wood-berry");
  Trajectory loop = run_closed_loop(study, study.plant.G, experiment_signals(study, basis_draw()),
                                    qp_solver_factory("auto"));
  std::vector<bool> counted(static_cast<std::size_t>(loop.y.cols()), true);
  std::fill(counted.begin() + 100, counted.begin() + 140, false);
  const Eigen::VectorXd costs = counted_costs(study, loop, counted);
  const double total = loop_cost(study, loop, counted).total();
  loop.y.middleCols(110, 20).array() += 1000.0;
  CHECK(counted_costs(study, loop, counted) == costs);
  CHECK(loop_cost(study, loop, counted).total() == total);
  CHECK(loop_cost(study, loop).total() > 10.0 * total);
}

TEST_CASE("a level that wanders within its range costs nothing, in a repair either", "[records]") {
  const Study study = find_study("suite-evaporator");
  REQUIRE(study.plant.G.is_integrating(0));  // a setpoint of little weight, and a range
  Trajectory loop;
  loop.y = Eigen::MatrixXd::Zero(study.cv_count(), study.simulation.samples);
  const std::vector<bool> all(static_cast<std::size_t>(loop.y.cols()), true);
  const double still = counted_costs(study, loop, all)(0);
  const double upper = study.controller.cv_soft.upper(0);
  for (Eigen::Index k = 0; k < loop.y.cols(); ++k)
    loop.y(0, k) = 0.9 * upper * std::sin(0.05 * static_cast<double>(k));
  CHECK(counted_costs(study, loop, all)(0) == still);
  loop.y(0, 7) = 2.0 * upper;
  CHECK(counted_costs(study, loop, all)(0) > still);
}

TEST_CASE("the cost of a CV is its controller's: about a setpoint, or outside of a range", "[records]") {
  const Study study = find_study("wood-berry");
  const Eigen::Index ny = study.cv_count();
  const Eigen::MatrixXd y0 =
      run_closed_loop(study, study.plant.G, experiment_signals(study, basis_draw().without_faults()),
                      qp_solver_factory("auto"))
          .y;
  const Eigen::MatrixXd noise = measurement_noise(study, 3);
  const Eigen::VectorXd v = noise.array().square().rowwise().mean();
  const auto ratio = [&](const Eigen::MatrixXd& y, Eigen::Index from) {
    return cost_of_record(study, y, y0, v, from);
  };
  const std::vector<CvCost> same = ratio(y0 + noise, 0);
  REQUIRE(std::ssize(same) == ny);
  for (const CvCost& cost : same)
    if (!std::isnan(cost.ratio))
      CHECK(cost.ratio == Approx(1.0).margin(0.25));  // 400 samples of noise
  Eigen::MatrixXd off = y0 + noise;
  off.row(0).tail(100).array() += 2.0;  // xD has a range of 1
  CHECK(ratio(off, 300).front().ratio > 2.0 * ratio(off, 0).front().ratio);
  off.row(0).setConstant(kNaN);
  CHECK(std::isnan(ratio(off, 0).front().ratio));
}

}  // namespace
}  // namespace mpm
