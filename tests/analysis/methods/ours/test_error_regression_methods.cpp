#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/identification/autoregression.hpp"
#include "analysis/identification/prewhitened_test.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/shared/error_regression.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

Study regression_shell(const std::string& options = "") {
  return parse_study(find_study("chapter4-shell").source + "\n" + options, "test");
}

/// A study with what its basis case says, made once for all its loops.
struct RegressionBench {
  explicit RegressionBench(Study chosen)
      : study(std::move(chosen)),
        basis(run_basis_case(study, testing::kFactory)),
        context(assessment_context(study, basis, testing::kFactory)) {}

  AssessedLoop loop(int scenario) const {
    return assessed_loop(study, basis.point,
                         simulate_experiment(study, draw_experiment(study, scenario), testing::kFactory));
  }
  Assessment assess(const std::string& method, const AssessedLoop& loop) const {
    return Assessor(assessment_method(method), context).assess(loop);
  }

  Study study;
  BasisCase basis;
  AssessmentContext context;
};

const RegressionBench& shell_bench() {
  static const RegressionBench bench(regression_shell());
  return bench;
}

// Numbers of the scenarios, from 0.
constexpr int kNominal = 0, kTimeConstantY1U1 = 1;

}  // namespace

TEST_CASE(
    "order and excitation: a mismatch is told with its CV and channel, the nominal loop is not flagged") {
  const RegressionBench& bench = shell_bench();
  for (const char* method : {"order", "excitation"}) {
    INFO(method);
    const Assessment nominal = bench.assess(method, bench.loop(kNominal));
    CHECK(nominal.status == AssessmentStatus::ok);
    CHECK_FALSE(nominal.flagged);
    CHECK(nominal.score < 2.0);  // -log10 of alpha = 0.01
    const Assessment found = bench.assess(method, bench.loop(kTimeConstantY1U1));
    CHECK(found.flagged);
    CHECK(found.worst_cv() == 0);
    CHECK(found.cvs[0].source == FaultSource::mpm);
    CHECK_FALSE(*found.cvs[1].flagged);
    CHECK_FALSE(*found.cvs[2].flagged);
    if (method == std::string("order"))
      CHECK(std::find(found.flagged_channels.begin(), found.flagged_channels.end(), Channel{0, 0}) !=
            found.flagged_channels.end());
  }
}

TEST_CASE("order: an error that the MVs do not explain is a disturbance, by its colour or its mean") {
  const RegressionBench& bench = shell_bench();
  AssessedLoop loop = bench.loop(kNominal);
  loop.y.row(2).array() += 0.02;  // twice the noise: a constant error
  const Assessment shifted = bench.assess("order", loop);
  CHECK(shifted.flagged);
  CHECK(shifted.worst_cv() == 2);
  CHECK(shifted.cvs[2].source == FaultSource::ud);
  CHECK(shifted.flagged_channels.empty());
  // Noise of three times the size has the same colour.
  AssessedLoop loud = bench.loop(kNominal);
  loud.y = loud.y_sim + 3.0 * (loud.y - loud.y_sim);
  CHECK_FALSE(bench.assess("order", loud).flagged);
  // It is the benchmark that is needed, and the option that turns it off.
  AssessmentContext unknown = bench.context;
  unknown.benchmark.reset();
  const Assessment without = Assessor(assessment_method("order"), unknown).assess(loop);
  CHECK_FALSE(without.flagged);
  CHECK(std::isnan(without.number("log10_p_noise", 2)));
  const RegressionBench alone(regression_shell("[assessment.order]\ndisturbances = false\n"));
  const Assessment model_only = alone.assess("order", loop);
  CHECK_FALSE(model_only.flagged);
  CHECK(model_only.score == without.score);
}

TEST_CASE("order and excitation: their p-values are those of the regression that they are made of") {
  const RegressionBench bench(
      regression_shell("[assessment.order]\nalpha = 0.2\nfilters = 3\npole = 0.6\nlargest_order = 5\n"
                       "[assessment.excitation]\nfilters = 2\npole = 0.95\nlargest_order = 3\n"));
  const AssessedLoop loop = bench.loop(kTimeConstantY1U1);
  const Eigen::MatrixXd e = model_errors(loop);
  const auto check = [&](const char* method, const Eigen::MatrixXd& signals,
                         const ErrorRegressionOptions& options) {
    const Assessment found = bench.assess(method, loop);
    const auto regressions = error_regressions(e, filtered_signals(signals, options), options);
    for (Eigen::Index cv = 0; cv < 3; ++cv) {
      const PrewhitenedTest& test = regressions[static_cast<std::size_t>(cv)]->test;
      CHECK(found.number("log10_p", cv) == Approx(test.all.log_p / std::log(10.0)));
      CHECK(found.number("autoregression", cv) == static_cast<double>(test.order));
    }
    return found;
  };
  const Assessment order = check("order", loop.u, {0.2, 3, 0.6, 5});
  const double least = std::min(order.number("log10_p", 0), order.number("log10_p_noise", 0));
  CHECK(order.cvs[0].score == Approx(-least - std::log10(6.0)));
  const Assessment excitation = check("excitation", loop.y_set, {0.01, 2, 0.95, 3});
  CHECK(excitation.cvs[0].score == Approx(-excitation.number("log10_p", 0) - std::log10(3.0)));

  CHECK_THROWS_WITH(regression_shell("[assessment.order]\npole = 1.0\n"),
                    Catch::Contains("assessment.order.pole"));
  CHECK_THROWS_WITH(regression_shell("[assessment.order]\nalpha = 0\n"),
                    Catch::Contains("assessment.order.alpha"));
  CHECK_THROWS_WITH(regression_shell("[assessment.excitation]\nmeasure = \"mi\"\n"),
                    Catch::Contains("mutual-information"));
  CHECK_THROWS_WITH(regression_shell("[assessment.excitation]\nbins = 1\n"), Catch::Contains("bins"));
}

TEST_CASE("order and excitation: what the MVs explain in the benchmark as well is not new") {
  const RegressionBench& bench = shell_bench();
  const AssessedLoop loop = bench.loop(kTimeConstantY1U1);
  const auto regressions_of = [](const AssessedLoop& record) {
    return error_regressions(model_errors(record), filtered_in_window(record, record.from_start().u, {}), {});
  };
  const ErrorRegressions found = regressions_of(loop);
  ErrorRegressions usual = regressions_of(*bench.context.benchmark);
  REQUIRE(found[0]->test.all.f > 10.0);
  const auto same_as = [](const FTest& one, const FTest& other, double divisor) {
    CHECK(one.f == Approx(other.f / divisor));
    CHECK(one.freedom == other.freedom);
    CHECK((divisor > 1.0 ? one.log_p > other.log_p : one.log_p == other.log_p));
  };
  // Nothing is usual: of no benchmark, of a CV without samples, of one in which the MVs explain nothing.
  usual[0]->test.all.f = 1.0;
  for (FTest& group : usual[0]->test.groups)
    group.f = 5.0;
  ErrorRegressions missing = usual;
  missing[0].reset();
  for (const ErrorRegressions& none : {ErrorRegressions{}, missing, usual}) {
    const PrewhitenedTest test = new_in(*found[0], 0, none);
    same_as(test.all, found[0]->test.all, 1.0);
    same_as(test.groups[0], found[0]->test.groups[0], 1.0);
  }
  usual[0]->test.all.f = 4.0;
  usual[0]->test.groups[1].f = 0.5;
  const double longer =
      static_cast<double>(found[0]->whiteness.freedom()) / static_cast<double>(usual[0]->whiteness.freedom());
  const PrewhitenedTest test = new_in(*found[0], 0, usual);
  same_as(test.all, found[0]->test.all, 1.0 + 3.0 * longer);
  same_as(test.groups[0], found[0]->test.groups[0], 1.0 + 4.0 * longer);
  same_as(test.groups[1], found[0]->test.groups[1], 1.0);
  // What is usual grows with the samples: a window of a third of them shows a third of it.
  const ErrorRegressions brief = regressions_of(window_of(loop, 100, loop.samples() / 3));
  const double part =
      static_cast<double>(brief[0]->whiteness.freedom()) / static_cast<double>(usual[0]->whiteness.freedom());
  CHECK(part < 0.4);
  same_as(new_in(*brief[0], 0, usual).all, brief[0]->test.all, 1.0 + 3.0 * part);
}

TEST_CASE("order and excitation: what a valve adds that no correction expresses is no fault") {
  Study study = find_study("wood-berry");
  study.simulation.excitation = SignalSequence::each;
  study.experiments = {.mpm = 4, .healthy = 8};
  study.mismatch.impact = Distribution::constant(3.0);
  study.world = WorldRanges{.count = 1,
                            .extra_lag = Distribution::constant(0.1),
                            .valve_curvature = Distribution::constant(0.8),
                            .cost_loops = 1,
                            .repair_loops = 1};
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  // A variant that is denied the correction is not told what it leaves in the benchmark either.
  const AssessmentContext told = assessment_context(study, basis, testing::kFactory);
  AssessmentContext untold = told;
  untold.correction.reset();
  const AssessedLoop loop = assessed_loop(
      study, basis.point, simulate_experiment(study, draw_experiment(study, 0), testing::kFactory));
  for (const std::string method : {"order", "excitation"}) {
    INFO(method);
    const auto says = [&](const std::string& name, const AssessmentContext& context) {
      const Assessment said = Assessor(shipped_methods().method(name), context).assess(loop);
      return std::pair(said.number("log10_p", 0), said.number("log10_p", 1));
    };
    CHECK(says(method + ":uncorrected", told) == says(method, untold));
    CHECK(says(method, told) != says(method, untold));
  }
  ExperimentRunner runner(study, basis, {"order", "excitation"}, testing::kFactory);
  int healthy = 0, mismatches = 0;
  for (std::int64_t index = 0; index < study.experiment_count(); ++index) {
    const ExperimentRecord record = runner.run(index, StorePolicy::none);
    for (const AssessmentRecord& said : record.assessments)
      (record.draw.kind == ExperimentKind::healthy ? healthy : mismatches) += said.flagged ? 1 : 0;
  }
  INFO(healthy << " of 16, " << mismatches << " of 8");
  CHECK(healthy <= 3);  // without what the benchmark leaves 10
  CHECK(mismatches >= 6);
}

TEST_CASE("order and excitation: a window of a record is that record from the start of the window on") {
  const RegressionBench& bench = shell_bench();
  const AssessedLoop loop = bench.loop(kTimeConstantY1U1);
  const AssessedLoop window = window_of(loop, 150, 200);
  const Eigen::VectorXd e = model_errors(window).row(0).transpose();
  const Autoregression whiteness = fit_autoregression(e, autoregression_order(e, 12));
  std::vector<Eigen::MatrixXd> filtered = filtered_signals(loop.u, {});
  for (Eigen::MatrixXd& group : filtered)
    group = Eigen::MatrixXd(group.middleRows(150, 200));
  CHECK(bench.assess("order", window).number("log10_p", 0) ==
        Approx(prewhitened_test(e, filtered, whiteness).all.log_p / std::log(10.0)));
  CHECK(bench.assess("excitation", window).status == AssessmentStatus::ok);
}

TEST_CASE("order and excitation: gaps are left out, and a record that is too short is not assessed") {
  const RegressionBench& bench = shell_bench();
  AssessedLoop loop = bench.loop(kTimeConstantY1U1);
  loop.y.row(0).segment(100, 8).setConstant(kNaN);
  loop.y.row(1).setConstant(kNaN);
  for (const char* method : {"order", "excitation"}) {
    const Assessment found = bench.assess(method, loop);
    INFO(method);
    CHECK(found.status == AssessmentStatus::ok);
    CHECK(found.worst_cv() == 0);
    CHECK_FALSE(found.cvs[1].flagged.has_value());
    AssessedLoop brief = loop;
    brief.y.rightCols(loop.samples() - 30).setConstant(kNaN);
    const Assessment none = bench.assess(method, brief);
    CHECK(none.status == AssessmentStatus::not_applicable);
    CHECK(none.reason.find("samples of a CV without a gap") != std::string::npos);
  }
}

TEST_CASE("order and excitation: an exact model in a loop without noise has no error to explain") {
  const RegressionBench& bench = shell_bench();
  AssessedLoop loop = bench.loop(kNominal);
  loop.y = loop.y_sim * (1.0 + 1e-15);
  CHECK_FALSE(bench.assess("excitation", loop).flagged);
  AssessmentContext unknown = bench.context;
  unknown.benchmark.reset();
  const Assessment order = Assessor(assessment_method("order"), unknown).assess(loop);
  CHECK(order.status == AssessmentStatus::ok);
  CHECK_FALSE(order.flagged);
}

TEST_CASE(
    "excitation: does not apply where nothing moves the loop from outside; limits and test signals do") {
  const RegressionBench& bench = shell_bench();
  AssessedLoop still = bench.loop(kTimeConstantY1U1);
  still.y_set.colwise() = Eigen::VectorXd(still.y_set.col(0));
  still.d.setZero();
  const Assessment none = bench.assess("excitation", still);
  CHECK(none.status == AssessmentStatus::not_applicable);
  CHECK(none.reason.find("no measured disturbance, setpoint, limit or test signal") != std::string::npos);

  // A loop that follows a test signal: its error is the response to it.
  Study moved = bench.study;
  moved.simulation.dither = {{.mv = 1, .amplitude = 0.05, .hold = 5}};
  const Eigen::MatrixXd added = dither(moved);
  const AssessmentContext context{moved, bench.basis, testing::kFactory, bench.context.benchmark};
  still.y = still.y_sim + (bench.context.benchmark->y - bench.context.benchmark->y_sim);
  still.y.row(1) += 0.2 * filtered_signals(added.row(1), {})[0].col(1).transpose();
  const Assessment found = Assessor(assessment_method("excitation"), context).assess(still);
  CHECK(found.worst_cv() == 1);
  CHECK(found.flagged);
}

TEST_CASE("excitation: the mutual information finds what no linear filter explains") {
  const std::string information = "[assessment.excitation]\nmeasure = \"mutual-information\"\n";
  const RegressionBench bench(regression_shell(information));
  AssessedLoop loop = *bench.context.benchmark;
  CHECK_FALSE(bench.assess("excitation", loop).flagged);
  // An error that is the square of the response to a setpoint: it is the same in both halves of the record,
  // and all that is linear in the setpoint has the other sign.
  const Eigen::Index half = loop.samples() / 2;
  Eigen::RowVectorXd moves = Eigen::RowVectorXd::Zero(loop.samples());
  RandomStream stream(5, 1, StreamId::excitation);
  for (Eigen::Index k = 3; k < half; ++k) {  // from rest: filters see deviations from the first sample
    moves(k) = k % 3 == 0 ? stream.normal() : moves(k - 1);
    moves(half + k) = -moves(k);
  }
  loop.y_set.setZero();
  loop.y_set.row(1) = moves;
  const Eigen::RowVectorXd response = filtered_signals(moves, {})[0].col(0).transpose();
  loop.y.row(1).array() += 0.05 * (response.array().square() - response.array().square().mean());
  CHECK_FALSE(*shell_bench().assess("excitation", loop).cvs[1].flagged);
  const Assessment found = bench.assess("excitation", loop);
  CHECK(found.flagged);
  CHECK(found.worst_cv() == 1);
}

}  // namespace mpm
