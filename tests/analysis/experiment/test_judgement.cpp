#include <catch2/catch.hpp>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/judgement_changes.hpp"
#include "analysis/findings/kind_findings.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/analysis/made_up_record.hpp"

// The answer of a method against the truth, question by question.

namespace {

using namespace mpm;
using testing::made_up_record;
using testing::verdict;

using Cvs = std::vector<Eigen::Index>;
using Form = std::shared_ptr<const AssessmentForm>;

constexpr Correctness kRight = Correctness::right, kWrong = Correctness::wrong,
                      kNotJudged = Correctness::not_judged;
constexpr FaultSource kNone = FaultSource::none, kMpm = FaultSource::mpm, kUd = FaultSource::ud;

const Study& chapter6() {
  static const Study study = find_study("chapter6");
  return study;
}

/// The form of a method that tells no more than this, on the loops of the chapter 6 study.
Form form_that(bool locates_cvs, bool tells_sources, bool names_channels) {
  MethodDescription method;
  method.name = "made_up";
  method.locates_cvs = locates_cvs;
  method.tells_sources = tells_sources;
  method.names_channels = names_channels;
  return std::make_shared<const AssessmentForm>(method, chapter6());
}

Correctness location(const ExperimentRecord& record) {
  return judge(chapter6(), record, record.assessments.front()).location();
}

// Random experiments

TEST_CASE("judgement: of a flagged experiment the CV and the source are judged, each by its own truth") {
  const ExperimentRecord mismatch = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  const auto judged = [&](Eigen::Index cv, FaultSource source) {
    return judge(chapter6(), mismatch, verdict(testing::chain_form(), true, 1.0, cv, source));
  };
  CHECK((judged(2, kMpm).predicted_cv == kRight && judged(2, kMpm).predicted_source == kRight));
  CHECK((judged(3, kMpm).predicted_cv == kWrong && judged(3, kMpm).predicted_source == kRight));
  CHECK((judged(2, kUd).predicted_cv == kRight && judged(2, kUd).predicted_source == kWrong));
  CHECK_FALSE(judged(2, kMpm).wrong());
  CHECK(judged(3, kMpm).wrong());
  CHECK(judged(2, kUd).wrong());
  CHECK(judged(2, kMpm).channel == kNotJudged);  // the chain names none
  CHECK_FALSE(judged(2, kMpm).cvs);
}

TEST_CASE("judgement: both faults have no one source, several affected CVs no one CV") {
  const ExperimentRecord both = made_up_record(0, ExperimentKind::mpm_ud, 2, 0.2);
  for (const FaultSource source : {kMpm, kUd}) {
    const Judgement judged = judge(chapter6(), both, verdict(testing::chain_form(), true, 1.0, 2, source));
    CHECK(judged.predicted_cv == kRight);
    CHECK(judged.predicted_source == kNotJudged);
    CHECK_FALSE(judged.wrong());
  }
  ExperimentRecord spread = made_up_record(0, ExperimentKind::ud, 2, 0.0);
  spread.draw.disturbances.push_back({3, 1.0, 50.0});
  const Judgement judged = judge(chapter6(), spread, verdict(testing::chain_form(), true, 1.0, 5, kUd));
  CHECK(judged.predicted_cv == kNotJudged);
  CHECK(judged.predicted_source == kRight);
}

TEST_CASE("judgement: what is not flagged is judged by its source, and only where the study counts it") {
  Study study = chapter6();
  const ExperimentRecord mismatch = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  const AssessmentRecord quiet = verdict(testing::chain_form(), false, 0.1, 4, kUd);
  REQUIRE(study.diagnosis.source_population == SourcePopulation::impactful);
  CHECK_FALSE(in_source_population(study, quiet));
  CHECK(judge(study, mismatch, quiet).predicted_source == kNotJudged);
  study.diagnosis.source_population = SourcePopulation::feasible;
  CHECK(in_source_population(study, quiet));
  const Judgement judged = judge(study, mismatch, quiet);
  CHECK(judged.predicted_source == kWrong);
  CHECK(judged.predicted_cv == kNotJudged);
  CHECK_FALSE(judged.wrong());  // a quiet loop makes no claim
}

TEST_CASE("judgement: without a verdict no question arises") {
  Study study = chapter6();
  study.diagnosis.source_population = SourcePopulation::feasible;
  const ExperimentRecord whole = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  const ExperimentRecord lost = testing::without_verdict(whole, ExperimentStatus::infeasible);
  ExperimentRecord failed = whole;
  failed.status = ExperimentStatus::failed;
  AssessmentRecord refused;
  refused.form = testing::chain_form();
  refused.status = AssessmentStatus::not_applicable;
  refused.flagged = true;  // must not matter
  for (const Judgement& judged :
       {judge(study, lost, lost.assessments[0]), judge(study, failed, failed.assessments[0]),
        judge(study, whole, refused)}) {
    CHECK((judged.predicted_cv == kNotJudged && judged.predicted_source == kNotJudged));
    CHECK((judged.channel == kNotJudged && !judged.cvs && !judged.flagged));
    CHECK_FALSE(judged.wrong());
  }
  CHECK_FALSE(in_source_population(study, refused));
}

TEST_CASE("judgement: a method answers for what it tells, and for nothing else") {
  const ExperimentRecord mismatch = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  const auto judged = [&](const Form& form) {
    AssessmentRecord said = verdict(form, true, 1.0, 5, kUd);  // wrong in everything
    return judge(chapter6(), mismatch, said);
  };
  const Judgement none = judged(form_that(false, false, false));
  CHECK((none.predicted_cv == kNotJudged && none.predicted_source == kNotJudged));
  CHECK(none.channel == kNotJudged);
  CHECK_FALSE(none.wrong());
  CHECK(judged(form_that(true, false, false)).predicted_cv == kWrong);
  CHECK(judged(form_that(true, false, false)).predicted_source == kNotJudged);
  CHECK(judged(form_that(true, true, false)).predicted_source == kWrong);
  CHECK(judged(form_that(false, false, true)).channel == kWrong);
  CHECK_FALSE(judged(form_that(false, false, true)).wrong());  // the CV and the source are asked
}

TEST_CASE("judgement: the channel is that of the only mismatch, and of an MV") {
  const Form form = form_that(false, false, true);
  Assessment names;
  names.flagged = true;
  names.flagged_channels = {{0, 2}, {2, 0}};
  const AssessmentRecord said = kept(form, names);
  ExperimentRecord record = made_up_record(0, ExperimentKind::mpm, 2, 0.2);  // its mismatch is in MV 0
  CHECK(judge(chapter6(), record, said).channel == kRight);
  record.draw.mismatches[0].input = 1;
  CHECK(judge(chapter6(), record, said).channel == kWrong);
  record.draw.mismatches[0].input = chapter6().mv_count();  // an MD
  CHECK(judge(chapter6(), record, said).channel == kNotJudged);
  record.draw.mismatches[0].input = 0;
  record.draw.mismatches.push_back({3, 1, MismatchParameter::gain, 2.0});
  CHECK(judge(chapter6(), record, said).channel == kNotJudged);
}

TEST_CASE("judgement: any flag where model and plant agree is wrong, on no CV and of no source") {
  for (const ExperimentKind kind : {ExperimentKind::healthy, ExperimentKind::tuning}) {
    ExperimentRecord record = made_up_record(0, ExperimentKind::ud, 0, 0.0);
    record.draw.kind = kind;
    record.draw.disturbances.clear();
    const Judgement quiet = judge(chapter6(), record, verdict(testing::chain_form(), false));
    const Judgement alarm = judge(chapter6(), record, verdict(testing::chain_form(), true, 1.0, 2, kUd));
    CHECK_FALSE(quiet.wrong());
    CHECK_FALSE(quiet.flagged_without_fault);
    CHECK(alarm.wrong());
    CHECK(alarm.flagged_without_fault);
    CHECK((alarm.location() == kNotJudged && alarm.source() == kNotJudged));
    for (const FlagTruth truth : {FlagTruth::fault, FlagTruth::impact})
      CHECK_FALSE(to_be_flagged(chapter6(), record, truth));
  }
}

TEST_CASE("a fault is to be flagged always, or when it has an impact: the truth, whatever the methods say") {
  ExperimentRecord record = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  record.assessments.clear();
  CHECK(has_impact(chapter6().diagnosis, record));
  CHECK(to_be_flagged(chapter6(), record, FlagTruth::impact));
  record.ivar_basis.setOnes();
  CHECK_FALSE(has_impact(chapter6().diagnosis, record));
  CHECK(to_be_flagged(chapter6(), record, FlagTruth::fault));
  CHECK_FALSE(to_be_flagged(chapter6(), record, FlagTruth::impact));
  record.ivar_basis(6) = 0.5;  // a variance that falls is an impact, too
  CHECK(has_impact(chapter6().diagnosis, record));
}

// Named scenarios

/// A scenario of three CVs: a mismatch on the first, a disturbance on the second.
ExperimentRecord scenario() {
  ExperimentRecord record;
  record.draw.named = true;
  record.draw.kind = ExperimentKind::mpm_ud;
  record.draw.mismatches = {{0, 0, MismatchParameter::gain, 2.0}};
  record.draw.disturbances = {{1, 1.0, 30.0}};
  record.status = ExperimentStatus::ok;
  return record;
}

/// What is said of each of three CVs; none of one that is not flagged.
struct Flags {
  FaultSource first = kNone, second = kNone, third = kNone;
};

const Study& shell() {
  static const Study study = find_study("chapter4-shell");
  return study;
}

Judgement judge_flags(const ExperimentRecord& record, const Flags& flags,
                      const Form& form = testing::form_of(shell(), "botelho")) {
  Assessment assessment;
  for (const FaultSource source : {flags.first, flags.second, flags.third})
    assessment.cvs.push_back({source != kNone, source != kNone ? 1.0 : 0.0, source});
  return judge(shell(), record, kept(form, assessment));
}

TEST_CASE("named scenario: each affected CV must be flagged with its source, and no other one") {
  const ExperimentRecord record = scenario();
  Judgement judged = judge_flags(record, {});
  CHECK(judged.cvs->missed == Cvs{0, 1});
  CHECK_FALSE(judged.cvs->judged_source);
  CHECK(judged.wrong());
  CHECK(judged.location() == kWrong);
  CHECK(judged.source() == kNotJudged);

  judged = judge_flags(record, {kMpm, kUd});
  CHECK(judged.cvs->found == Cvs{0, 1});
  CHECK(judged.cvs->right());
  CHECK_FALSE(judged.wrong());
  CHECK(judged.location() == kRight);
  CHECK(judged.source() == kRight);

  judged = judge_flags(record, {kMpm, kUd, kMpm});
  CHECK(judged.cvs->false_alarms == Cvs{2});
  CHECK(judged.location() == kWrong);
  CHECK(judged.source() == kRight);

  judged = judge_flags(record, {kMpm, kMpm});
  CHECK(judged.cvs->wrong_source == Cvs{1});
  CHECK(judged.cvs->located());
  CHECK(judged.wrong());
  CHECK(judged.source() == kWrong);
}

TEST_CASE("named scenario: with both faults on a CV either source is right") {
  ExperimentRecord record = scenario();
  record.draw.disturbances.front().cv = 0;
  for (const FaultSource source : {kMpm, kUd}) {
    CHECK(judge_flags(record, {source}).cvs->right());
    CHECK_FALSE(judge_flags(record, {source}).cvs->judged_source);
  }
}

TEST_CASE("named scenario: the study may say that no CV is affected") {
  ExperimentRecord record = scenario();
  record.draw.affected_cvs.emplace();
  CHECK(judge_flags(record, {}).cvs->right());
  CHECK(judge_flags(record, {kMpm}).cvs->false_alarms == Cvs{0});
}

TEST_CASE(
    "named scenario: a method is judged by its CVs when it looks at them, by its sources when it has any") {
  MethodDescription method;
  method.name = "made_up";
  const auto form = [&] { return std::make_shared<const AssessmentForm>(method, shell()); };
  CHECK_FALSE(judge_flags(scenario(), {kMpm, kUd, kUd}, form()).cvs);
  CHECK_FALSE(judge_flags(scenario(), {kMpm, kUd, kUd}, form()).wrong());
  method.locates_cvs = true;
  const Judgement located = judge_flags(scenario(), {kUd, kUd}, form());
  CHECK(located.cvs->right());
  CHECK_FALSE(located.cvs->judged_source);
  CHECK(located.source() == kNotJudged);
}

TEST_CASE("named scenario: a CV of which the method says nothing is one that it does not flag") {
  Assessment assessment;
  assessment.cvs = {{true, 1.0, kMpm}, {}, {}};
  const Judgement judged = judge(shell(), scenario(), kept(testing::form_of(shell(), "botelho"), assessment));
  CHECK(judged.cvs->found == Cvs{0});
  CHECK(judged.cvs->missed == Cvs{1});
  CHECK(judged.cvs->false_alarms.empty());
}

// Counts, and two runs

/// Experiments of every kind and status, right and wrong, in equal parts by chance.
std::vector<ExperimentRecord> random_records(std::uint64_t seed, int count) {
  RandomStream stream(seed, 0, StreamId::measurement_noise);
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<ExperimentKind>(1 + i % 3);
    records.push_back(made_up_record(i, kind, i % 7, stream.below(2) == 0 ? 0.05 : 0.2));
    ExperimentRecord& record = records.back();
    record.assessments[0].flagged = stream.below(3) > 0;
    record.assessments[0].predicted_cv = static_cast<Eigen::Index>((i + stream.below(2)) % 7);
    const auto status = static_cast<ExperimentStatus>(stream.below(8) < 6 ? 0 : 1 + stream.below(2));
    if (status != ExperimentStatus::ok)
      record = testing::without_verdict(record, status);
  }
  return records;
}

template <class Question>
void check_counts(const std::vector<ExperimentRecord>& records, ExperimentKind kind, const Question& question,
                  const Rate& rate) {
  std::int64_t right = 0, asked = 0;
  for (const ExperimentRecord& record : records)
    if (record.draw.kind == kind) {
      right += question(record) == kRight ? 1 : 0;
      asked += question(record) == kNotJudged ? 0 : 1;
    }
  CHECK(right == rate.hits);
  CHECK(asked == rate.total);
}

TEST_CASE("judgements, counted one by one, are the rates of the findings") {
  Study study = chapter6();
  study.aggregate.bootstrap_replications = 100;
  const std::vector<ExperimentRecord> records = random_records(1, 300);
  for (const SourcePopulation population : {SourcePopulation::impactful, SourcePopulation::feasible}) {
    study.diagnosis.source_population = population;
    const auto source = [&](const ExperimentRecord& record) {
      return judge(study, record, record.assessments[0]).source();
    };
    const std::vector<KindFindings> kinds = kind_collector(study, *testing::chain_form(), 0).of(records);
    REQUIRE(kinds.size() == 3);
    for (const KindFindings& kind : kinds) {
      check_counts(records, kind.kind, location, kind.located);
      check_counts(records, kind.kind, source, kind.source_recognised);
    }
  }
}

JudgementChanges location_changes(const std::vector<ExperimentRecord>& before,
                                  const std::vector<ExperimentRecord>& now) {
  JudgementChanges changes;
  each_in_both(before, now, [&](const ExperimentRecord& was, const ExperimentRecord& is) {
    changes.add({is.draw.index, location(was), location(is)}, is.draw.world);
  });
  return changes;
}

TEST_CASE("judgement changes: what is lost and gained is named, and a vanished verdict is lost") {
  std::vector<ExperimentRecord> before, now;
  for (int i = 0; i < 6; ++i)
    before.push_back(made_up_record(i, ExperimentKind::mpm, 2, 0.2));
  now = before;
  const auto said = [](ExperimentRecord& record) -> AssessmentRecord& { return record.assessments[0]; };
  said(now[1]).predicted_cv = 3;                                 // right -> wrong
  said(now[2]).flagged = false;                                  // right -> not judged
  said(before[3]).predicted_cv = 5;                              // wrong -> right
  before[4].status = ExperimentStatus::failed;                   // not judged -> right
  said(before[5]).predicted_cv = said(now[5]).predicted_cv = 6;  // wrong -> wrong
  const JudgementChanges changes = location_changes(before, now);
  CHECK(changes.pairs == 6);
  REQUIRE(changes.lost.size() == 2);
  CHECK(changes.lost[0].index == 1);
  CHECK(changes.lost[0].now == kWrong);
  CHECK(changes.lost[1].index == 2);
  CHECK(changes.lost[1].now == kNotJudged);
  REQUIRE(changes.gained.size() == 2);
  CHECK(changes.gained[0].index == 3);
  CHECK(changes.gained[1].before == kNotJudged);
  CHECK(changes.test().p_worse == Approx(11.0 / 16.0));  // 2 or more of 4 coins
}

TEST_CASE("judgement changes: swapping the runs swaps losses and gains") {
  const std::vector<ExperimentRecord> a = random_records(2, 200);
  const std::vector<ExperimentRecord> b = random_records(3, 200);
  const JudgementChanges there = location_changes(a, b);
  const JudgementChanges back = location_changes(b, a);
  CHECK(there.lost.size() > 10);
  CHECK(there.lost.size() == back.gained.size());
  CHECK(there.gained.size() == back.lost.size());
  CHECK(there.pairs == back.pairs);
  CHECK(there.test().p_two_sided == back.test().p_two_sided);
}

TEST_CASE("judgement changes: experiments of one run alone are not compared") {
  const std::vector<ExperimentRecord> before = random_records(4, 60);
  std::vector<ExperimentRecord> now(before.begin() + 10, before.begin() + 40);
  now.push_back(made_up_record(60, ExperimentKind::mpm, 0, 0.2));
  const JudgementChanges changes = location_changes(before, now);
  CHECK(changes.pairs > 0);
  CHECK(changes.pairs == location_changes(now, now).pairs - 1);
  CHECK(changes.lost.empty());
}

}  // namespace
