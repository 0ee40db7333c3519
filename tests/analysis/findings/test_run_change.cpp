#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/run_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace mpm {
namespace {

using testing::chain_form;
using testing::made_up_record;

/// A run of the chapter 6 study with experiments whose answers are made up.
struct MadeUpRun {
  Study study = find_study("chapter6");
  AssessmentForms forms{chain_form()};
  std::vector<ExperimentRecord> records;
  Calibration calibration;

  explicit MadeUpRun(std::int64_t experiments = 20) {
    for (std::int64_t i = 0; i < experiments; ++i)
      records.push_back(made_up_record(i, i % 2 == 0 ? ExperimentKind::mpm : ExperimentKind::ud, 1,
                                       i % 2 == 0 ? 0.2 : 0.05));
  }
  StudyRun run() const { return {study, forms, records, calibration}; }
  /// Lets the chain of an experiment say something else.
  void say(std::int64_t index, bool flagged, Eigen::Index cv) {
    ExperimentRecord& record = records[static_cast<std::size_t>(index)];
    record.assessments[0].flagged = flagged;
    record.assessments[0].predicted_cv = cv;
  }
};

MethodChange change_of(const MadeUpRun& before, const MadeUpRun& now) {
  const std::vector<MethodChange> changes =
      method_changes(before.run(), now.run(), pair_runs(before.run(), now.run()));
  REQUIRE(changes.size() == 1);
  return changes[0];
}

const VerdictChange& verdict_of(const MethodChange& change, const std::string& question) {
  for (const VerdictChange& verdict : change.verdicts)
    if (verdict.question->name == question)
      return verdict;
  throw std::runtime_error("no question " + question);
}

const RateChange& rate_of(const MethodChange& change, const std::string& name) {
  for (const RateChange& rate : change.rates)
    if (rate.row->name == name)
      return rate;
  throw std::runtime_error("no rate " + name);
}

TEST_CASE("run change: nothing changed between a run and itself") {
  const MadeUpRun run;
  const RunPairing pairing = pair_runs(run.run(), run.run());
  CHECK(pairing.paired());
  CHECK(pairing.loops == 20);
  CHECK(pairing.same_loops == 20);
  const MethodChange change = change_of(run, run);
  CHECK_FALSE(change.changed());
  for (const RateChange& rate : change.rates) {
    CHECK(rate.difference.value == 0.0);
    CHECK(rate.p_holm == 1.0);
  }
}

TEST_CASE(
    "run change: rates of paired runs are those of rate_collector, and differ by the loops that changed") {
  const MadeUpRun before;
  MadeUpRun now;
  now.say(3, true, 2);    // the wrong CV
  now.say(4, false, -1);  // not flagged any more
  const MethodChange change = change_of(before, now);
  const MethodRates was = rate_collector(before.study, 0).of(before.records);
  const MethodRates is = rate_collector(now.study, 0).of(now.records);
  for (const RateChange& rate : change.rates) {
    INFO(rate.row->name);
    CHECK(rate.before.hits == was.rates.of(*rate.row).hits);
    CHECK(rate.before.total == was.rates.of(*rate.row).total);
    CHECK(rate.now.hits == is.rates.of(*rate.row).hits);
    CHECK(rate.now.total == is.rates.of(*rate.row).total);
  }
  const RateChange& located = rate_of(change, "located");
  CHECK(located.counts.total() == 19);  // the loop that is not flagged is not counted in B
  CHECK(located.counts.first == 1);
  CHECK(located.difference.value == Approx(-1.0 / 19.0));

  const VerdictChange& cv = verdict_of(change, "CV");
  REQUIRE(cv.changes.lost.size() == 2);
  CHECK(cv.changes.lost[0].index == 3);
  CHECK(cv.changes.lost[0].now == Correctness::wrong);
  CHECK(cv.changes.lost[1].now == Correctness::not_judged);
  CHECK(cv.changes.gained.empty());
  CHECK(cv.changes.clusters.sum().both == 18);
  CHECK(change.changed());
  const MethodChange back = change_of(now, before);
  CHECK(verdict_of(back, "CV").changes.gained.size() == 2);
  CHECK(rate_of(back, "located").difference.value == -located.difference.value);
}

TEST_CASE("run change: only experiments in common are compared") {
  const MadeUpRun before(20);
  MadeUpRun now(8);
  now.say(3, false, -1);
  const RunPairing pairing = pair_runs(before.run(), now.run());
  CHECK(pairing.loops == 8);
  CHECK(rate_of(change_of(before, now), "detected").before.total == 8);

  // Either may lack experiments that the other one has.
  MadeUpRun gaps = before, others = before;
  std::erase_if(gaps.records, [](const ExperimentRecord& record) { return record.draw.index % 3 == 0; });
  std::erase_if(others.records, [](const ExperimentRecord& record) { return record.draw.index % 2 == 0; });
  CHECK(pair_runs(gaps.run(), others.run()).loops == 7);  // 1, 5, 7, 11, 13, 17, 19
  CHECK(pair_runs(others.run(), gaps.run()).loops == 7);
}

TEST_CASE("run change: numbers change by what the method says, largest change and experiment by name") {
  const MadeUpRun before;
  MadeUpRun now;
  now.records[5].assessments[0].set_number("i_mpm", 0.75);
  now.records[7].assessments[0].set_number("ivar", std::nan(""), 2);
  const MethodChange change = change_of(before, now);
  bool seen = false;
  for (const NumberChange& number : change.numbers) {
    if (number.label == "ivar")
      CHECK(number.same == 19);
    if (number.label != "I_{MPM}")
      continue;
    seen = true;
    CHECK(number.experiments == 20);
    CHECK(number.same == 19);
    CHECK(number.index == 5);
    CHECK(number.largest == Approx(0.7));
    CHECK(number.difference.mean == Approx(0.7 / 20.0));
  }
  CHECK(seen);
}

TEST_CASE("run change: runs of other seeds, faults or plants are not paired, and the reason is told") {
  const MadeUpRun before;
  const auto obstacle = [&](const MadeUpRun& now) { return pair_runs(before.run(), now.run()).obstacle; };
  MadeUpRun seed, fault, variables, none(0);
  seed.study.seed = before.study.seed + 1;
  CHECK_THAT(obstacle(seed), Catch::Contains("the seeds differ"));
  fault.records[6].draw.mismatches[0].value = 0.6;
  CHECK(obstacle(fault) == "experiment 6 does not have the same fault in both");
  variables.study.plant.cvs[0].name = "other";
  CHECK(obstacle(variables) == "the plants have different variables");
  CHECK(obstacle(none) == "they have no experiment in common");

  const MethodChange change = change_of(before, seed);
  CHECK(change.verdicts.empty());
  CHECK(change.numbers.empty());
  const RateChange& detected = rate_of(change, "detected");
  CHECK(detected.difference.value == 0.0);
  // As of strangers: wider than of pairs that agree throughout, and both are Newcombe's.
  CHECK(detected.difference.interval.lower ==
        independent_difference(detected.before, detected.now).interval.lower);
}

TEST_CASE("run change: loops with another truth are counted") {
  const MadeUpRun before;
  MadeUpRun now;
  now.records[2].ivar_basis(0) += 1e-9;
  CHECK(pair_runs(before.run(), now.run()).same_loops == 19);
}

}  // namespace
}  // namespace mpm
