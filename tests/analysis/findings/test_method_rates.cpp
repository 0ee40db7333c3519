#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include <catch2/catch.hpp>

#include "analysis/findings/method_pairs.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/literature/badwe2009.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/random/random_stream.hpp"
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
  MethodRates rates() const { return rate_collector(study(), 0).of(records); }
  std::vector<MethodPair> pairs() const { return pair_collector(study(), 2).of(records); }
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

TEST_CASE("what is said of simulated records is not said by a threshold that they set", "[findings]") {
  Case of;
  for (int i = 0; i < 100; ++i)  // every second one scores higher than all others
    of.add(ExperimentKind::healthy, verdict(false, i % 2 == 0 ? i : 1000.0 + i));
  of.add(ExperimentKind::mpm, verdict(false, 5000.0, 1, FaultSource::mpm));
  const TrialFindings found = trial_findings(study(), 0, of.records, verdict(true, 1.0));
  CHECK(found.threshold > 1090.0);  // of all of them
  CHECK(found.threshold_for(0) > 1090.0);
  CHECK(found.threshold_for(1) < 100.0);
  check_rate(found.rates["false_alarm_healthy"], 50, 100);
  check_rate(found.rates["detected"], 1, 1);
}

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
  check_rate(rates["answered"], 11, 13);
  check_rate(rates["detected"], 6, 9);
  check_rate(rates["detected_mpm"], 3, 4);
  check_rate(rates["detected_ud"], 2, 4);
  check_rate(rates["detected_impact"], 6, 8);
  check_rate(rates["flagged_without_impact"], 0, 1);
  check_rate(rates["false_alarm_healthy"], 1, 2);
  check_rate(rates["false_alarm_tuning"], 0, 0);
  check_rate(rates["located"], 5, 6);
  check_rate(rates["source"], 3, 5);
  check_rate(rates["channel"], 0, 0);  // the method names none
  const Interval wilson = wilson_interval(6, 9, study().aggregate.confidence);
  CHECK(rates["detected"].interval.lower == wilson.lower);
  CHECK(rates["detected"].interval.upper == wilson.upper);
}

TEST_CASE("rates of a method: faults are told three ways, over all of them", "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true, 1, 1, kIsMpm));  // right
  made.add(kMpm, verdict(true, 1, 1, kIsUd));
  made.add(kMpm, verdict(false, 1, 1, kIsMpm));  // said of no fault: no source
  made.add(kUd, verdict(true, 1, 1, kIsUd));     // right
  made.add(kUd, verdict(true, 1, 1));            // no source
  made.add(kBoth, verdict(true, 1, 1, kIsMpm));
  made.add(kBoth, verdict(true, 1, 1, FaultSource::mpm_ud));  // right
  made.add(kUd, no_verdict(AssessmentStatus::failed));        // no source
  made.add(kUd, no_verdict(AssessmentStatus::not_assessed));  // nobody asked
  made.add(kNone, verdict(true, 1, 1, kIsMpm));               // no fault
  check_rate(made.rates()["source_all"], 3, 8);
  check_rate(made.rates()["abstained"], 3, 8);

  Case tells_none;
  const auto form = testing::form_of(study(), "sse");
  REQUIRE_FALSE(form->method().tells_sources);
  tells_none.add(kMpm, testing::verdict(form, true, 1.0, 1));
  check_rate(tells_none.rates()["source_all"], 0, 0);
  check_rate(tells_none.rates()["abstained"], 0, 0);
}

TEST_CASE("rates of a method: of another fault the word for it is right, and a flag without a source",
          "[method_rates]") {
  const auto other_record = [](std::int64_t index) {
    ExperimentRecord record = made_up_record(index, kUd, 1, 0.2);
    record.draw.kind = ExperimentKind::other;
    return record;
  };
  Case made;
  made.add(other_record(1), verdict(true, 1, 1, FaultSource::other), verdict(false));  // right
  made.add(other_record(2), verdict(true, 1, 1), verdict(false));                      // right
  made.add(other_record(3), verdict(true, 1, 1, kIsUd), verdict(false));
  made.add(other_record(4), verdict(false, 1, 1, FaultSource::other), verdict(false));  // not flagged
  made.add(kMpm, verdict(true, 1, 1, FaultSource::other));
  check_rate(made.rates()["source_all"], 2, 5);
  check_rate(made.rates()["abstained"], 2, 5);
}

TEST_CASE("rates of a method: what could not be had is said by part of the study", "[method_rates]") {
  Study both = study();
  MethodRates rates{};
  CHECK(unanswered_parts(both, rates).empty());
  both.calibration.emplace();
  both.monitoring.emplace();
  const std::vector<UnansweredPart> parts = unanswered_parts(both, rates);
  REQUIRE(parts.size() == 2);
  CHECK((parts[0].name == std::string("calibration") && parts[1].name == std::string("windows")));
  rates.thresholds.not_mpm.loops = 1;
  rates.estimates["false_alarms_a_day"].count = 1;
  CHECK(unanswered_parts(both, rates).empty());
}

TEST_CASE("rates of a method: by the truth of impact a fault without one is a negative", "[method_rates]") {
  Case made;
  ExperimentRecord quiet = made_up_record(50, kMpm, 1, 0.2);
  quiet.ivar_basis.setOnes();
  made.add(quiet, verdict(true, 4.0), verdict(false));
  made.add(kMpm, verdict(true, 3.0));
  made.add(kUd, verdict(true, 5.0));
  made.add(kNone, verdict(false, 1.0));
  made.add(kNone, verdict(false, 2.0));
  const MethodRates rates = made.rates();
  CHECK(rates.roc.area == 1.0);
  CHECK(rates.roc_impact.positives == 2);
  CHECK(rates.roc_impact.negatives == 3);
  CHECK(rates.roc_impact.area ==
        Approx(5.0 / 6.0).epsilon(1e-12));  // of 2 x 3 pairs one is in the wrong order
  CHECK(rates.roc_impact_area.contains(rates.roc_impact.area));
}

TEST_CASE("false alarms are marked when their interval does not hold what the method states",
          "[method_rates]") {
  MethodDescription method;
  MethodRates rates{};
  CHECK(false_alarm_mark(method, rates) == FalseAlarmMark::none);  // nothing was looked at
  rates["false_alarm_healthy"] = rate(10, 100);                    // 5.5 to 17.4 %
  CHECK(false_alarm_mark(method, rates) == FalseAlarmMark::more);  // than the usual 5 %
  method.stated_false_alarms = 0.1;
  CHECK(false_alarm_mark(method, rates) == FalseAlarmMark::none);
  method.stated_false_alarms = 0.2;
  CHECK(false_alarm_mark(method, rates) == FalseAlarmMark::fewer);

  Study other = study();
  CHECK(testing::form_of(other, "yu-qin")->method().stated_false_alarms == Approx(0.025));
  CHECK(testing::form_of(other, "yu-qin:largest-root")->method().stated_false_alarms == Approx(0.025));
  CHECK(testing::form_of(other, "badwe2009")->method().stated_false_alarms == Approx(0.05));
  other.assessment.of<Badwe2009Options>().confidence = 0.99;
  CHECK(testing::form_of(other, "badwe2009")->method().stated_false_alarms == Approx(0.01));
  other.assessment.of<Badwe2009Options>().multiplicity = Multiplicity::lags;
  CHECK_FALSE(testing::form_of(other, "badwe2009")->method().stated_false_alarms.has_value());
  CHECK_FALSE(testing::form_of(other, "sse")->method().stated_false_alarms.has_value());
}

TEST_CASE("the best method is one that answers and detects", "[method_rates]") {
  MethodRates rates{};
  rates["answered"] = rate(95, 100, 0.95);
  rates["detected"] = rate(20, 80, 0.95);
  rates["detected_impact"] = rate(18, 30, 0.95);
  rates["false_alarm_healthy"] = rate(1, 20, 0.95);
  rates["located"] = rates["source"] = rate(20, 20, 0.95);
  CHECK(answers_and_detects(rates));
  MethodRates silent = rates;
  silent["detected_impact"] = rate(2, 30, 0.95);
  CHECK_FALSE(answers_and_detects(silent));
  MethodRates absent = rates;
  absent["answered"] = rate(80, 100, 0.95);
  CHECK_FALSE(answers_and_detects(absent));
  MethodRates indifferent = rates;
  indifferent["false_alarm_healthy"] = rate(19, 20, 0.95);
  CHECK_FALSE(answers_and_detects(indifferent));
  MethodRates without_impact = rates;
  without_impact["detected_impact"] = rate(0, 0, 0.95);
  CHECK_FALSE(answers_and_detects(without_impact));
  without_impact["detected"] = rate(50, 80, 0.95);
  CHECK(answers_and_detects(without_impact));
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
  check_rate(rates["false_alarm_tuning"], 2, 3);
  check_rate(rates["false_alarm_healthy"], 0, 1);
  check_rate(rates["detected"], 1, 1);
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
  check_rate(made.rates()["located"], 0, 0);
  check_rate(made.rates()["source"], 1, 1);
}

TEST_CASE("rates of a method: channels are counted for methods that name them, under one mismatch of an MV",
          "[method_rates]") {
  for (const AssessmentMethodInfo& info : shipped_methods().methods()) {
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
    check_rate(made.rates()["channel"], info.names_channels ? 1 : 0, info.names_channels ? 2 : 0);
  }
}

TEST_CASE("rates of a method: channel, parameter and size of a mismatch with impact", "[method_rates]") {
  MethodDescription method;
  method.name = "namer";
  method.names_channels = method.names_mismatches = true;
  const auto form = std::make_shared<const AssessmentForm>(method, study());
  const auto truth = [](double impact) {
    ExperimentRecord record = made_up_record(0, kMpm, 1, impact);
    record.draw.mismatches = {{1, 2, MismatchParameter::gain, 0.5}};
    record.ivar_basis.setConstant(impact);
    return record;
  };
  const auto says = [&](Channel channel, MismatchParameter parameter, double size, bool flagged = true) {
    Assessment said;
    said.flagged = flagged;
    said.flagged_channels = {channel, {0, 0}};
    said.named_mismatch = {channel, parameter, size, size - 0.1, size + 0.1};
    return kept(form, said);
  };
  constexpr auto kGain = MismatchParameter::gain;
  Case made;
  for (const AssessmentRecord& said :
       {says({1, 2}, kGain, 0.55), says({1, 2}, kGain, 0.8), says({1, 2}, MismatchParameter::dead_time, 3.0),
        says({1, 1}, kGain, 0.5), says({1, 2}, kGain, 0.5, false)})
    made.add(truth(3.0), said, said);
  made.add(truth(1.0), says({1, 2}, kGain, 0.7), verdict(false));  // without impact
  const MethodRates rates = made.rates();
  check_rate(rates["channel"], 4, 5);         // of those that are flagged
  check_rate(rates["channel_impact"], 3, 5);  // what is not flagged is not named
  check_rate(rates["parameter_impact"], 2, 5);
  check_rate(rates["size_covered"], 1, 3);
  CHECK(rates.estimates["size_error"].value == Approx(0.4));  // 0.1, 0.4 and 0.6 of the deviation of 0.5
  CHECK(rates.estimates["channels_named"].value == 2.0);
  CHECK(rates.estimates["channels_named"].count == 5);
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

TEST_CASE("paired methods: p-values are corrected within each truth, for the pairs that have loops",
          "[method_rates]") {
  // Of three methods the third gives no verdict: one pair a truth has loops, and is not corrected.
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 6; ++i) {
    records.push_back(made_up_record(i, kMpm, 1, 0.2));
    records.back().assessments = {verdict(true), verdict(false), no_verdict(AssessmentStatus::failed)};
  }
  std::vector<MethodPair> pairs = pair_collector(study(), 3).of(records);
  REQUIRE(pairs.size() == 6);
  CHECK(pairs[0].test.p_two_sided == 2.0 / 64.0);
  CHECK(pairs[0].p_holm == pairs[0].test.p_two_sided);
  CHECK(pairs[1].p_holm == 1.0);
  for (ExperimentRecord& record : records)
    record.assessments[2] = verdict(false);  // as the second one: p = 1/32, 1/32, 1
  pairs = pair_collector(study(), 3).of(records);
  CHECK(pairs[0].p_holm == 6.0 / 64.0);
  CHECK(pairs[1].p_holm == 6.0 / 64.0);
  CHECK(pairs[2].p_holm == 1.0);
  CHECK(pairs[3].p_holm == 6.0 / 64.0);
}

TEST_CASE("paired methods: every pair once for each truth", "[method_rates]") {
  CHECK(pair_collector(study(), 1).of({}).empty());
  const std::vector<MethodPair> pairs = pair_collector(study(), 3).of({});
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

TEST_CASE(
    "rates of a method in worlds: the share of the best repair's gain, and the source at 5 % false alarms",
    "[method_rates]") {
  Study worlds = study();
  worlds.world.emplace();
  worlds.calibration = CalibrationOptions{.healthy = 40, .ud = 0};
  const auto form = testing::form_of(worlds, "lasso");
  // The repair of (1, 0) brings 0.4, that of (1, 1) a quarter of it, that of (2, 0) does harm.
  RepairGains gains{Eigen::MatrixXd::Zero(7, 3), Eigen::MatrixXd::Zero(7, 3)};
  gains.gain(1, 0) = 0.4;
  gains.gain(1, 1) = 0.1;
  gains.gain(2, 0) = -0.2;
  gains.error.setConstant(0.01);
  const auto says = [&](bool flagged, double score, const std::vector<Channel>& channels) {
    Assessment said;
    said.flagged = flagged;
    said.score = score;
    said.flagged_channels = channels;
    AssessmentRecord record = kept(form, said);
    record.predicted_cv = 1;
    record.predicted_source = FaultSource::mpm;
    return record;
  };
  std::vector<ExperimentRecord> records;
  const auto add = [&](const AssessmentRecord& said, ExperimentKind kind = kMpm) {
    ExperimentRecord record = made_up_record(static_cast<std::int64_t>(records.size()), kind, 1, 0.2);
    record.draw.world = static_cast<int>(records.size()) % 2;
    record.cost.emplace();
    record.cost->variance_ratio = record.ivar_basis;
    if (kind != kUd)
      record.repair = gains;
    record.assessments = {said};
    records.push_back(record);
  };
  add(says(true, 50.0, {{1, 0}}));          // the best: 1
  add(says(true, 50.0, {{1, 1}, {2, 0}}));  // the first that it names: 1/4
  add(says(true, 50.0, {{2, 0}}));          // harm: 0
  add(says(true, 5.0, {{1, 0}}));           // 1, but 0 below the threshold of 5 %
  add(says(false, 50.0, {{1, 0}}));         // 0, but 1 above it
  add(says(true, 50.0, {}));                // names none: 0
  AssessmentRecord silent;
  silent.form = form;
  silent.status = AssessmentStatus::failed;
  add(silent);  // no verdict: 0
  add(says(true, 50.0, {{1, 0}}), kUd);
  records.push_back(records.front());
  records.back().repair.error.setConstant(1.0);  // no repair has a gain beyond chance: not counted
  Calibration calibration;
  for (int loop = 0; loop < 40; ++loop) {
    CalibrationLoop& healthy = calibration.loops.emplace_back();
    healthy.kind = ExperimentKind::healthy;
    healthy.scores = {static_cast<double>(loop)};
  }
  const MethodRates rates = rate_collector(worlds, 0, calibration).of(records);
  REQUIRE(rates.thresholds.at_05.value);
  CHECK(rates.estimates["repair_gain_share"].count == 7);
  CHECK(rates.estimates["repair_gain_share"].value == Approx(2.25 / 7.0));
  CHECK(rates.estimates["repair_gain_share"].clusters.size() == 3);  // that of the exact world first
  CHECK(rates.estimates["repair_gain_share"].interval.contains(rates.estimates["repair_gain_share"].value));
  CHECK(rates.estimates["repair_gain_share_05"].value == Approx(2.25 / 7.0));
  // Above the threshold with `mismatch`: all but the fourth, the one without a verdict, and the disturbance.
  check_rate(rates["source_05_impact"], 6, 9);
  check_rate(rates["source_05_mpm"], 6, 8);
  check_rate(rates["source_05_ud"], 0, 1);
  check_rate(rates["mismatch_05_impact"], 6, 8);  // of those with a verdict; the disturbance is called one
  const std::vector<Finding> rows = rows_of(worlds, rates, form->method());
  CHECK(std::any_of(rows.begin(), rows.end(), [](const Finding& row) {
    return row.name == "compare.lasso.repair_gain_share_05" && row.value > 0.3 && row.interval.upper < 1.0;
  }));
}

TEST_CASE("a question at equal false alarms is asked of the loops that it is about, and of no others",
          "[method_rates]") {
  const OutcomeScope scope{.tells_sources = true, .at_05 = true, .in_worlds = true};
  const auto ask = [](const char* name, const OutcomeScope& of, const FaultTruth& truth,
                      const LoopOutcome& said) {
    return row_of(rate_rows(), name).ask({of, truth, said});
  };
  const FaultTruth mismatch{kMpm, true, true}, disturbance{kUd, true, true};
  const std::optional<bool> none;
  for (const bool above : {false, true})
    for (const Correctness told : {Correctness::wrong, Correctness::right}) {
      const bool right = told == Correctness::right;
      const LoopOutcome said{.answered = true,
                             .flagged = true,
                             .above_05 = above,
                             .right_source = right,
                             .channel = told,
                             .parameter = told,
                             .size = told,
                             .mismatch = told};
      CHECK(ask("mismatch_05_impact", scope, mismatch, said) == (above && right));
      CHECK(ask("mismatch_05_impact", scope, disturbance, said) == (!above || right));  // silence is right
      CHECK(ask("source_05_mpm", scope, mismatch, said) == (above && right));
      CHECK(ask("source_05_ud", scope, disturbance, said) == (above && right));
      CHECK(ask("source_05_mpm", scope, disturbance, said) == none);
      CHECK(ask("source_05_ud", scope, mismatch, said) == none);
      for (const char* const name : {"channel_05_impact", "parameter_05_impact", "size_05_impact"}) {
        INFO(name);
        CHECK(ask(name, scope, mismatch, said) == (above && right));
        CHECK(ask(name, scope, mismatch, {.answered = true, .above_05 = true}) == none);   // it names none
        CHECK(ask(name, scope, {kMpm, false, true}, said) == none);                        // without impact
        CHECK(ask(name, {.tells_sources = true, .at_05 = true}, mismatch, said) == none);  // no worlds
        CHECK(ask(name, {.tells_sources = true, .in_worlds = true}, mismatch, said) == none);
      }
    }
}

TEST_CASE("no two numbers of a method have the same name or heading", "[method_rates]") {
  std::set<std::string> names, headings;
  for (const MethodNumber& number : method_numbers()) {
    INFO(number.name << ", " << number.heading);
    CHECK(names.insert(number.name).second);
    CHECK(headings.insert(number.heading).second);
    CHECK(heading_of(number.name) == number.heading);
    CHECK_FALSE(std::string(number.meaning).empty());
  }
  CHECK(headings.size() >= rate_rows().size() + estimate_rows().size());
  CHECK_THROWS_AS(heading_of("no_such_number"), std::out_of_range);
}

TEST_CASE("a further rate is a row", "[method_rates]") {
  constexpr RateRow kHealthySaid[] = {
      {{"healthy_said", "Healthy, as said", "share of the healthy loops"},
       [](const JudgedLoop& l) { return !l.truth.faulty(); },
       [](const JudgedLoop& l) { return l.said.answered && !l.said.flagged; }}};
  RateCounts counts(kHealthySaid);
  const OutcomeScope scope;
  for (const bool flagged : {true, false, false})
    counts.add({scope, FaultTruth{}, LoopOutcome{.answered = true, .flagged = flagged}}, 0);
  counts.add({scope, FaultTruth{.kind = kMpm}, LoopOutcome{.answered = true}}, 0);
  check_rate(counts.rates(0.95)["healthy_said"], 2, 3);
}

TEST_CASE("the rates have one list: every rate once, and a finding of its own", "[method_rates]") {
  Case made;
  made.add(kMpm, verdict(true, 2.0));
  made.add(kMpm, verdict(false, 1.0));
  made.add(kNone, verdict(false, 0.0));
  const MethodRates rates = made.rates();
  const std::vector<Finding> rows = rows_of(study(), rates, testing::chain_form()->method());
  const std::size_t estimates = rows_for(study(), estimate_rows()).size();
  REQUIRE(rows.size() == rows_for(study(), rate_rows()).size() + area_rows().size() + estimates);
  CHECK(rows[0].name == "compare.botelho.answered");
  CHECK(rows[1].name == "compare.botelho.detected");
  CHECK(rows[1].value == 0.5);
  CHECK(rows[1].count == 2);
  CHECK(rows[1].hits == 1);
  CHECK(rows[1].is_share());
  CHECK(rows[1].method == "botelho");
  CHECK(rows[1].interval.lower == rates["detected"].interval.lower);
  const Finding& area = rows[rows.size() - estimates - 2];
  CHECK(area.name == "compare.botelho.roc_area");
  CHECK_FALSE(area.is_share());
  CHECK(area.value == 1.0);
  CHECK(area.count == 3);
  CHECK(rows[rows.size() - estimates - 1].name == "compare.botelho.roc_area_impact");

  // Rates at calibrated thresholds, and the thresholds, are of studies with a calibration; delays of those
  // that monitor; the rate of named causes of those that log candidates.
  CHECK(std::none_of(rows.begin(), rows.end(),
                     [](const Finding& row) { return row.name == "compare.botelho.power_05"; }));
  Study calibrated = study();
  calibrated.calibration.emplace();
  calibrated.monitoring.emplace();
  calibrated.record.candidates = 1;
  calibrated.world.emplace();
  CHECK(rows_of(calibrated, rates, testing::chain_form()->method()).size() == method_numbers().size() - 1);
}

}  // namespace mpm
