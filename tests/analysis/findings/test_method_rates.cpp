#include <cmath>
#include <set>
#include <tuple>

#include <catch2/catch.hpp>

#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_table.hpp"
#include "scenarios/random_stream.hpp"
#include "scenarios/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace mpm {
namespace {

using testing::made_up_record;

const Study& study() {
  static const Study chapter6 = find_study("chapter6");
  return chapter6;
}

AssessmentRecord verdict(bool flagged, double score = 0.0, Eigen::Index cv = -1,
                         FaultSource source = FaultSource::none) {
  return testing::verdict(testing::chain_form(), flagged, score, cv, source);
}

/// No verdict, for a reason of this sort.
AssessmentRecord no_verdict(AssessmentStatus status) {
  AssessmentRecord record;
  record.form = testing::chain_form();
  record.status = status;
  return record;
}

ExperimentRecord healthy_record(std::int64_t index) {
  ExperimentRecord record = made_up_record(index, ExperimentKind::ud, 0, 0.0);
  record.draw.kind = ExperimentKind::healthy;
  record.draw.disturbances.clear();
  return record;
}

/// Loops with their truth, assessed by two methods whose verdicts are made up.
struct Case {
  std::vector<ExperimentRecord> records;

  void add(ExperimentRecord truth, const AssessmentRecord& first, const AssessmentRecord& second) {
    truth.assessments = {first, second};
    records.push_back(std::move(truth));
  }
  void add(ExperimentKind kind, const AssessmentRecord& first,
           const AssessmentRecord& second = verdict(false)) {
    const auto index = static_cast<std::int64_t>(records.size());
    add(kind == ExperimentKind::healthy ? healthy_record(index) : made_up_record(index, kind, 1, 0.2), first,
        second);
  }
  MethodRates rates() const { return method_rates(study(), 0, records); }
  std::vector<MethodPair> pairs() const { return method_pairs(study(), 2, records); }
};

void check_rate(const Rate& rate, std::int64_t hits, std::int64_t total) {
  CHECK(rate.hits == hits);
  CHECK(rate.total == total);
  if (total == 0)
    CHECK(std::isnan(rate.value));
  else
    CHECK(rate.value == static_cast<double>(hits) / static_cast<double>(total));
}

constexpr ExperimentKind kMpm = ExperimentKind::mpm, kUd = ExperimentKind::ud, kBoth = ExperimentKind::mpm_ud,
                         kNone = ExperimentKind::healthy;
constexpr FaultSource kIsMpm = FaultSource::mpm, kIsUd = FaultSource::ud;

}  // namespace

TEST_CASE("rates of a method: every loop is counted where it belongs", "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true, 1, 1, kIsMpm));   // all right
  made.add(kMpm, verdict(true, 1, 1, kIsUd));    // wrong source
  made.add(kMpm, verdict(true, 1, 3, kIsMpm));   // wrong CV
  made.add(kMpm, verdict(false, 1, 1, kIsMpm));  // missed: neither located nor a source
  made.add(kUd, verdict(true, 1, 1, kIsUd));
  made.add(kUd, verdict(true, 1, 1, kIsMpm));
  made.add(kUd, verdict(false));
  made.add(kBoth, verdict(true, 1, 1, kIsMpm));  // two faults have no one source
  made.add(kNone, verdict(true));
  made.add(kNone, verdict(false));
  made.add(kMpm, no_verdict(AssessmentStatus::failed));  // in `answered` only
  made.add(kNone, no_verdict(AssessmentStatus::not_applicable));
  made.add(kMpm, no_verdict(AssessmentStatus::not_assessed));  // nobody asked: it counts nowhere

  ExperimentRecord without_impact = made_up_record(100, kUd, 1, 0.2);
  without_impact.ivar_basis.setOnes();
  made.add(without_impact, verdict(false), verdict(false));

  const MethodRates rates = made.rates();
  check_rate(rates.answered, 11, 13);
  check_rate(rates.detected, 6, 9);
  check_rate(rates.detected_mpm, 3, 4);
  check_rate(rates.detected_ud, 2, 4);
  check_rate(rates.detected_impact, 6, 8);
  check_rate(rates.flagged_without_impact, 0, 1);
  check_rate(rates.false_alarm_healthy, 1, 2);
  check_rate(rates.false_alarm_tuning, 0, 0);
  check_rate(rates.located, 5, 6);
  check_rate(rates.source, 3, 5);
  check_rate(rates.channel, 0, 0);  // the method names none
  const Interval wilson = wilson_interval(6, 9, study().aggregate.confidence);
  CHECK(rates.detected.interval.lower == wilson.lower);
  CHECK(rates.detected.interval.upper == wilson.upper);
}

TEST_CASE("rates of a method: a loop with bad tuning is no healthy one, and not on the ROC curve",
          "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true, 2.0));
  made.add(kNone, verdict(false, 1.0));
  for (const bool flagged : {true, true, false}) {
    ExperimentRecord tuned = healthy_record(static_cast<std::int64_t>(made.records.size()));
    tuned.draw.kind = ExperimentKind::tuning;
    made.add(tuned, verdict(flagged, 3.0), verdict(false));
  }
  const MethodRates rates = made.rates();
  check_rate(rates.false_alarm_tuning, 2, 3);
  check_rate(rates.false_alarm_healthy, 0, 1);
  check_rate(rates.detected, 1, 1);
  CHECK(rates.roc.area == 1.0);
  CHECK(rates.roc.negatives == 1);
}

TEST_CASE("rates of a method: a flagged loop with several affected CVs has no one to be located",
          "[method_rates]") {
  Case made;
  ExperimentRecord two = made_up_record(0, kUd, 1, 0.2);
  two.draw.disturbances.push_back({3, 1.0, 50.0});
  REQUIRE(two.draw.true_cv() == -1);
  made.add(two, verdict(true, 1, 1, kIsUd), verdict(false));
  check_rate(made.rates().located, 0, 0);
  check_rate(made.rates().source, 1, 1);
}

TEST_CASE("rates of a method: channels are counted for methods that name them, under one mismatch of an MV",
          "[method_rates]") {
  for (const AssessmentMethodInfo& info : assessment_methods()) {
    Case made;
    const auto names = [form = testing::form_of(study(), info.name)](std::vector<Channel> channels) {
      Assessment said;
      said.flagged = true;
      said.flagged_channels = std::move(channels);
      return kept(form, said);
    };
    // made_up_record() has its mismatch in MV 0 of the CV
    const AssessmentRecord right = names({{0, 2}, {1, 0}}), wrong = names({{0, 1}, {1, 1}});
    made.add(kMpm, right);
    made.add(kMpm, wrong);
    made.add(kUd, right);
    made.add(kMpm, verdict(false));
    ExperimentRecord of_md = made_up_record(50, kMpm, 1, 0.2);
    of_md.draw.mismatches[0].input = study().mv_count();
    made.add(of_md, right, right);
    INFO(info.name);
    check_rate(made.rates().channel, info.names_channels ? 1 : 0, info.names_channels ? 2 : 0);
  }
}

TEST_CASE("rates of a method: the area under ROC is the share of pairs in the right order",
          "[method_rates]") {
  RandomStream stream(1, 2, StreamId::measurement_noise);
  Case made;
  std::vector<double> faults, healthy;
  for (int i = 0; i < 60; ++i) {
    const bool fault = i % 3 != 0;
    double score = std::floor(10.0 * stream.uniform()) + (fault ? 2.0 : 0.0);  // with ties
    if (i % 10 == 7)
      score = std::nan("");
    made.add(fault ? kMpm : kNone, verdict(false, score));
    if (!std::isnan(score))
      (fault ? faults : healthy).push_back(score);
  }
  double ordered = 0.0;
  for (const double fault : faults)
    for (const double other : healthy)
      ordered += fault > other ? 1.0 : fault == other ? 0.5 : 0.0;
  const MethodRates rates = made.rates();
  CHECK(rates.roc.left_out == 6);
  CHECK(rates.roc.positives == static_cast<std::int64_t>(faults.size()));
  // Sums of quotients against one quotient: to rounding.
  CHECK(rates.roc.area ==
        Approx(ordered / static_cast<double>(faults.size() * healthy.size())).epsilon(1e-12));
  CHECK(rates.roc_area.contains(rates.roc.area));
}

TEST_CASE("rates of a method: without healthy loops there is no curve, and its interval is NaN",
          "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true, 1.0));
  CHECK_FALSE(made.rates().roc.defined());
  CHECK(std::isnan(made.rates().roc.area));
  CHECK(std::isnan(made.rates().roc_area.lower));
}

TEST_CASE("rates of a method: the cost is the median over loops with a verdict", "[method_rates]") {
  Case made;
  for (const double seconds : {0.010, 0.001, std::nan(""), 0.002}) {
    AssessmentRecord answer = verdict(true);
    answer.milliseconds = 1e3 * seconds;
    made.add(kMpm, answer);
  }
  AssessmentRecord failed = no_verdict(AssessmentStatus::failed);
  failed.milliseconds = 1e5;
  made.add(kMpm, failed);
  CHECK(made.rates().milliseconds == Approx(2.0).epsilon(1e-12));
  CHECK(std::isnan(Case().rates().milliseconds));
}

TEST_CASE("paired methods: right is a flagged fault or a quiet healthy loop, on loops that both answer",
          "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true), verdict(false));                        // the first alone is right
  made.add(kMpm, verdict(false), verdict(true));                        // the second
  made.add(kNone, verdict(true), verdict(false));                       // the second
  made.add(kNone, verdict(true), verdict(false));                       // the second
  made.add(kUd, verdict(true), verdict(true));                          // both
  made.add(kNone, verdict(true), verdict(true));                        // neither
  made.add(kMpm, no_verdict(AssessmentStatus::failed), verdict(true));  // none of the first
  const std::vector<MethodPair> pairs = made.pairs();
  REQUIRE(pairs.size() == 2);
  const MethodPair& pair = pairs[0];
  CHECK(pair.truth == FlagTruth::fault);
  CHECK(pair.loops == 6);
  CHECK(pair.test.lost == 1);
  CHECK(pair.test.gained == 3);
  CHECK(pair.test.p_two_sided == Approx(2.0 * 5.0 / 16.0).epsilon(1e-12));  // P(X >= 3), X ~ B(4, 1/2)
  CHECK(pair.test.p_worse == Approx(15.0 / 16.0).epsilon(1e-12));           // P(X >= 1)
}

TEST_CASE("paired methods: a fault without impact is to be flagged by the one truth and not by the other",
          "[method_rates]") {
  Case made;
  ExperimentRecord quiet = made_up_record(0, kMpm, 1, 0.2);
  quiet.ivar_basis.setOnes();
  made.add(quiet, verdict(true), verdict(false));
  made.add(kMpm, verdict(true), verdict(false));
  const std::vector<MethodPair> pairs = made.pairs();
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].truth == FlagTruth::fault);
  CHECK(pairs[0].test.lost == 2);
  CHECK(pairs[0].test.gained == 0);
  CHECK(pairs[1].truth == FlagTruth::impact);
  CHECK(pairs[1].test.lost == 1);
  CHECK(pairs[1].test.gained == 1);
}

TEST_CASE("paired methods: every pair once for each truth", "[method_rates]") {
  CHECK(method_pairs(study(), 1, {}).empty());
  const std::vector<MethodPair> pairs = method_pairs(study(), 3, {});
  REQUIRE(pairs.size() == 6);
  std::set<std::tuple<FlagTruth, std::size_t, std::size_t>> different;
  for (const MethodPair& pair : pairs) {
    CHECK(pair.first < pair.second);
    CHECK(pair.second < 3);
    CHECK(pair.loops == 0);
    different.insert({pair.truth, pair.first, pair.second});
  }
  CHECK(different.size() == 6);
}

TEST_CASE("rates of a method: why there was no verdict is that of the first loop without one",
          "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true));
  CHECK(made.rates().reason.empty());
  for (const char* reason : {"the first", "the second"}) {
    AssessmentRecord failed = no_verdict(AssessmentStatus::failed);
    failed.reason = reason;
    made.add(kMpm, failed);
  }
  CHECK(made.rates().reason == "the first");
}

TEST_CASE("the rates have one list: every rate once, and a finding of its own", "[method_rates]") {
  std::set<std::string> names;
  std::set<const Rate*> members;
  const MethodRates none{};
  for (const MethodRateInfo& info : method_rate_infos()) {
    names.insert(info.name);
    members.insert(&(none.*info.rate));
  }
  CHECK(names.size() == method_rate_infos().size());
  CHECK(members.size() == method_rate_infos().size());

  Case made;
  made.add(kMpm, verdict(true, 2.0));
  made.add(kMpm, verdict(false, 1.0));
  made.add(kNone, verdict(false, 0.0));
  const MethodRates rates = made.rates();
  const std::vector<Finding> rows = rows_of(rates, testing::chain_form()->method());
  REQUIRE(rows.size() == method_rate_infos().size() + 1);
  CHECK(rows[0].name == "compare.botelho.answered");
  CHECK(rows[1].name == "compare.botelho.detected");
  CHECK(rows[1].value == 0.5);
  CHECK(rows[1].count == 2);
  CHECK(rows[1].hits == 1);
  CHECK(rows[1].is_share());
  CHECK(rows[1].method == "botelho");
  CHECK(rows[1].interval.lower == rates.detected.interval.lower);
  CHECK(rows.back().name == "compare.botelho.roc_area");
  CHECK_FALSE(rows.back().is_share());
  CHECK(rows.back().value == 1.0);
  CHECK(rows.back().count == 3);
}

}  // namespace mpm
