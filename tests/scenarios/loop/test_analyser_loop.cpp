#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "tests/solvers/active_set_factory.hpp"

// Closed loops in which an analyser measures a CV.

namespace mpm {
namespace {

constexpr Eigen::Index kLoopSamples = 60, kTop = 0, kBottom = 1;

/// The column without noise, its bottom product measured by an analyser of this timing.
Study analysed_column(const AnalyserTiming& timing) {
  Study study = find_study("wood-berry");
  study.simulation.samples = kLoopSamples;
  study.controller.analysers = {{}, timing};
  return study;
}

/// The feed steps at sample 5, a disturbance on the bottom product at `onset`.
LoopSignals moved_by(double feed, double disturbance, Eigen::Index onset) {
  LoopSignals made{Eigen::MatrixXd::Zero(1, kLoopSamples), Eigen::MatrixXd::Zero(2, kLoopSamples),
                   Eigen::MatrixXd::Zero(2, kLoopSamples)};
  made.d.rightCols(kLoopSamples - 5).setConstant(feed);
  made.y_d.row(kBottom).tail(kLoopSamples - onset).setConstant(disturbance);
  return made;
}

Trajectory loop_of(const Study& study, const LoopSignals& signals) {
  Trajectory loop = run_closed_loop(study, study.plant.G, signals, testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  return loop;
}

}  // namespace

TEST_CASE("analyser: an exact model needs no measurement, the moves are those without analyser",
          "[analyser]") {
  const LoopSignals feed_step = moved_by(0.3, 0.0, 0);
  const Trajectory measured = loop_of(analysed_column({}), feed_step);
  const Trajectory analysed = loop_of(analysed_column({7, 4}), feed_step);
  CHECK(measured.u.cwiseAbs().maxCoeff() > 0.01);
  CHECK((analysed.u - measured.u).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((analysed.y.row(kTop) - measured.y.row(kTop)).cwiseAbs().maxCoeff() < 1e-9);
  for (Eigen::Index k = 4; k < kLoopSamples; ++k)
    CHECK(analysed.y(kBottom, k) == Approx(measured.y(kBottom, (k - 4) / 7 * 7)).margin(1e-9));
}

TEST_CASE("analyser: the controller answers a disturbance when its first analysis is there", "[analyser]") {
  const Study study = analysed_column({5, 3});
  const Trajectory quiet = loop_of(study, moved_by(0.3, 0.0, 0));
  // Taken at samples 10 and 15, shown at 13 and 18: the step at sample 11 is first seen at 18.
  const Trajectory disturbed = loop_of(study, moved_by(0.3, 0.2, 11));
  CHECK(disturbed.u.leftCols(18) == quiet.u.leftCols(18));
  CHECK((disturbed.u.col(18) - quiet.u.col(18)).cwiseAbs().maxCoeff() > 1e-4);
  CHECK(disturbed.y(kBottom, 17) == quiet.y(kBottom, 17));
  CHECK(disturbed.y(kBottom, 18) - quiet.y(kBottom, 18) == Approx(0.2));
}

TEST_CASE("analyser: a constant disturbance on its CV is rejected", "[analyser]") {
  Study study = analysed_column({5, 3});
  study.simulation.samples = 400;
  LoopSignals step{Eigen::MatrixXd::Zero(1, 400), Eigen::MatrixXd::Zero(2, 400),
                   Eigen::MatrixXd::Zero(2, 400)};
  step.y_d.row(kBottom).tail(380).setConstant(0.2);
  const Trajectory loop = loop_of(study, step);
  CHECK(loop.y(kBottom, 30) > 0.05);
  CHECK(loop.y(kBottom, 399) == Approx(study.controller.cv_soft.upper(kBottom)).margin(2e-3));
}

TEST_CASE("an MD that is told as late as its dead times allow is one that acts that much earlier",
          "[analyser]") {
  // The dead times of the feed are 8.1 and 3.4 min: told 3 samples late it is one of 5.1 and 0.4 min.
  Study late = analysed_column({});
  late.controller.md_analysers = {{1, 3}};
  Study sooner = analysed_column({});
  for (Eigen::Index cv : {kTop, kBottom}) {
    TransferFunction& channel = sooner.plant.G(cv, 2);
    channel = TransferFunction(channel.numerator(), channel.denominator(), channel.dead_time() - 3.0);
  }
  const LoopSignals feed_step = moved_by(0.3, 0.0, 0);
  LoopSignals three_later = feed_step;
  three_later.d.setZero();
  three_later.d.rightCols(kLoopSamples - 8).setConstant(0.3);
  const Trajectory told_late = loop_of(late, feed_step), at_once = loop_of(sooner, three_later);
  CHECK((told_late.u.col(7) - told_late.u.col(0)).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((told_late.u.col(8) - told_late.u.col(7)).cwiseAbs().maxCoeff() > 1e-3);
  CHECK((told_late.u - at_once.u).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((told_late.y - at_once.y).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(told_late.d == three_later.d);  // the record has it when the controller has
}

TEST_CASE("an MD that is told later than it acts is no output bias once it is told", "[analyser]") {
  // The feed steps at sample 5 and moves the bottom product from sample 9 on: told 9 samples late, at 14.
  Study late = analysed_column({});
  late.controller.md_analysers = {{1, 9}};
  const Study at_once = analysed_column({});
  const LoopSignals feed_step = moved_by(0.3, 0.0, 0);
  const Trajectory told_late = loop_of(late, feed_step), told_at_once = loop_of(at_once, feed_step);
  const auto difference = [&](Eigen::Index k) {
    return (told_late.u_target - told_at_once.u_target).col(k).cwiseAbs().maxCoeff();
  };
  CHECK(difference(4) < 1e-9);
  CHECK(difference(13) > 1e-3);
  CHECK(difference(14) < 1e-9);  // the model explains all of y in both loops
  CHECK((told_late.y - told_at_once.y).col(20).cwiseAbs().maxCoeff() > 1e-3);
}

}  // namespace mpm
