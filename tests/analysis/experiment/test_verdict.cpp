#include <catch2/catch.hpp>

#include "analysis/experiment/verdict.hpp"
#include "analysis/findings/study_aggregate.hpp"
#include "analysis/findings/verdict_changes.hpp"
#include "plants/error.hpp"
#include "scenarios/random_stream.hpp"
#include "scenarios/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace {

using namespace mpm;
using testing::made_up_record;

/// Experiments of every kind and status, right and wrong, in equal parts by chance.
std::vector<ExperimentRecord> random_records(std::uint64_t seed, int count) {
  RandomStream stream(seed, 0, StreamId::measurement_noise);
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<ExperimentKind>(1 + i % 3);
    records.push_back(made_up_record(i, kind, i % 7, stream.below(2) == 0 ? 0.05 : 0.2));
    ExperimentRecord& record = records.back();
    record.diagnosis.impactful = stream.below(3) > 0;
    record.diagnosis.predicted_cv = static_cast<Eigen::Index>((i + stream.below(2)) % 7);
    record.status = static_cast<ExperimentStatus>(stream.below(8) < 6 ? 0 : 1 + stream.below(2));
    if (record.status != ExperimentStatus::ok)
      record.diagnosis = {};
  }
  return records;
}

void check_counts(const std::vector<ExperimentRecord>& records, ExperimentKind kind, const Question& question,
                  const Rate& rate) {
  std::int64_t right = 0, asked = 0;
  for (const ExperimentRecord& record : records)
    if (record.draw.kind == kind) {
      right += question(record) == Verdict::right ? 1 : 0;
      asked += question(record) == Verdict::none ? 0 : 1;
    }
  CHECK(right == rate.hits);
  CHECK(asked == rate.total);
}

TEST_CASE("verdicts, counted one by one, are the rates of the aggregate") {
  Study study = find_study("chapter6");
  study.aggregate.bootstrap_replications = 100;
  const std::vector<ExperimentRecord> records = random_records(1, 300);
  for (const SourcePopulation population : {SourcePopulation::impactful, SourcePopulation::feasible}) {
    study.diagnosis.source_population = population;
    const auto source = [&](const ExperimentRecord& record) { return source_verdict(study, record); };
    const StudyAggregate total = aggregate(study, records);
    for (const KindAggregate& kind : total.kinds) {
      check_counts(records, kind.kind, location_verdict, kind.located);
      check_counts(records, kind.kind, source, kind.source_recognised);
    }
  }
}

TEST_CASE("verdict changes: what is lost and gained is named, and a vanished verdict is lost") {
  std::vector<ExperimentRecord> before, now;
  for (int i = 0; i < 6; ++i)
    before.push_back(made_up_record(i, ExperimentKind::mpm, 2, 0.2));
  now = before;
  now[1].diagnosis.predicted_cv = 3;                                     // right -> wrong
  now[2].diagnosis.impactful = false;                                    // right -> none
  before[3].diagnosis.predicted_cv = 5;                                  // wrong -> right
  before[4].status = ExperimentStatus::failed;                           // none -> right
  before[5].diagnosis.predicted_cv = now[5].diagnosis.predicted_cv = 6;  // wrong -> wrong
  const VerdictChanges changes = verdict_changes(before, now, location_verdict);
  CHECK(changes.pairs == 6);
  REQUIRE(changes.lost.size() == 2);
  CHECK(changes.lost[0].index == 1);
  CHECK(changes.lost[0].now == Verdict::wrong);
  CHECK(changes.lost[1].index == 2);
  CHECK(changes.lost[1].now == Verdict::none);
  REQUIRE(changes.gained.size() == 2);
  CHECK(changes.gained[0].index == 3);
  CHECK(changes.gained[1].before == Verdict::none);
  CHECK(changes.test.p_worse == Approx(11.0 / 16.0));  // 2 or more of 4 coins
}

TEST_CASE("verdict changes: swapping the runs swaps losses and gains") {
  const std::vector<ExperimentRecord> a = random_records(2, 200);
  const std::vector<ExperimentRecord> b = random_records(3, 200);
  const VerdictChanges there = verdict_changes(a, b, location_verdict);
  const VerdictChanges back = verdict_changes(b, a, location_verdict);
  CHECK(there.lost.size() > 10);
  CHECK(there.lost.size() == back.gained.size());
  CHECK(there.gained.size() == back.lost.size());
  CHECK(there.pairs == back.pairs);
  CHECK(there.test.p_two_sided == back.test.p_two_sided);
}

TEST_CASE("verdict changes: a part of the earlier run will do, other experiments will not") {
  const std::vector<ExperimentRecord> before = random_records(4, 60);
  std::vector<ExperimentRecord> now(before.begin() + 10, before.begin() + 40);
  CHECK(verdict_changes(before, now, location_verdict).lost.empty());
  now.push_back(made_up_record(60, ExperimentKind::mpm, 0, 0.2));
  CHECK_THROWS_WITH(
      verdict_changes(before, now, location_verdict),
      "experiments: found number 60, which the earlier run has not; allowed: experiments of the "
      "earlier run");
  now = {made_up_record(0, ExperimentKind::ud, 5, 0.2)};
  CHECK_THROWS_WITH(verdict_changes(before, now, location_verdict),
                    "experiment 0: found ud on CV 5; allowed: what the earlier run has, mpm on CV 0");
}

}  // namespace
