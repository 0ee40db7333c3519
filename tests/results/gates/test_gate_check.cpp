#include <algorithm>

#include <catch2/catch.hpp>

#include "plants/error.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_report.hpp"
#include "scenarios/files/study_file.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

/// The made-up campaign, in which every experiment that can be judged is right.
Campaign good_campaign() {
  Campaign campaign = made_up_campaign();
  campaign.study.aggregate.bootstrap_replications = 100;
  remove_methods(campaign, [](const std::string& name) { return name != "botelho"; });
  for (ExperimentRecord& record : campaign.records) {
    if (record.status == ExperimentStatus::failed)
      record.status = ExperimentStatus::infeasible;
    if (record.status != ExperimentStatus::ok)
      continue;
    Diagnosis chain = testing::diagnosis_of(record.chain());
    chain.impactful = true;
    chain.predicted_cv = record.draw.true_cv();
    chain.predicted_source = source_of(record.draw.kind);
    set_chain(campaign.study, record, chain);
  }
  return campaign;
}

/// Spoils the location of the first `count` experiments of a kind that have one.
void mislocate(Campaign& campaign, ExperimentKind kind, int count) {
  for (ExperimentRecord& record : campaign.records)
    if (record.draw.kind == kind && record.status == ExperimentStatus::ok && count-- > 0)
      record.assessments.front().predicted_cv = 1 - record.draw.true_cv();
}

GateFile gates(const Campaign& campaign, const std::string& text) {
  return parse_gates(text, "g.toml", gate_findings(campaign.study));
}

const GateResult& result_of(const GateCheck& check, const std::string& name) {
  const auto found = std::find_if(check.results.begin(), check.results.end(),
                                  [&](const GateResult& result) { return result.gate.name == name; });
  REQUIRE(found != check.results.end());
  return *found;
}

const std::string kLocated = "[[gate]]\naggregate = \"ud.located\"\nminimum = 0.6\nreason = \"because\"\n";
const std::string kSure = kLocated + "with_confidence = true\n";

TEST_CASE("gate check: a campaign passes, fails or stays open, as its numbers say") {
  Campaign campaign = good_campaign();
  CHECK(check_gates(campaign, gates(campaign, kSure)).passed());
  mislocate(campaign, ExperimentKind::ud, 2);
  const GateCheck open = check_gates(campaign, gates(campaign, kSure));
  CHECK(result_of(open, "ud.located").outcome == GateOutcome::inconclusive);
  CHECK_FALSE(open.passed());
  CHECK(check_gates(campaign, gates(campaign, "inconclusive = \"pass\"\n" + kSure)).passed());
  CHECK(check_gates(campaign, gates(campaign, kLocated)).passed());  // the value itself keeps to it
  mislocate(campaign, ExperimentKind::ud, 100);
  const GateCheck failed = check_gates(campaign, gates(campaign, "inconclusive = \"pass\"\n" + kSure));
  CHECK(result_of(failed, "ud.located").outcome == GateOutcome::fail);
  CHECK_FALSE(failed.passed());
}

TEST_CASE("gate check: the confidence of the file takes the place of the study's") {
  Campaign campaign = good_campaign();
  campaign.study.aggregate.confidence = 0.95;
  const auto width = [&](const std::string& text) {
    const GateCheck check = check_gates(campaign, gates(campaign, text + kSure));
    return check.results.back().measured.interval.upper - check.results.back().measured.interval.lower;
  };
  CHECK(width("confidence = 0.5\n") < width(""));
  CHECK(width("confidence = 0.95\n") == width(""));
  CHECK(width("confidence = 0.999\n") > width(""));
}

TEST_CASE("gate check: failed and missing experiments and an unhealthy basis case stop every campaign") {
  const Campaign good = good_campaign();
  Campaign campaign = good;
  campaign.records[5].status = ExperimentStatus::failed;
  CHECK(result_of(check_gates(campaign, gates(campaign, kLocated)), "failed").outcome == GateOutcome::fail);
  CHECK(check_gates(campaign, gates(campaign, "maximum_failed = 1\n" + kLocated)).passed());
  campaign = good;
  campaign.basis.healthy = false;
  CHECK(result_of(check_gates(campaign, gates(campaign, kLocated)), "self_check").outcome ==
        GateOutcome::fail);
  CHECK_FALSE(check_gates(good, gates(good, "minimum_experiments = 41\n" + kLocated)).passed());
  CHECK(check_gates(good, gates(good, "minimum_experiments = 40\n" + kLocated)).passed());
  const Campaign nothing = empty_campaign();
  CHECK_FALSE(check_gates(nothing, gates(nothing, kLocated)).passed());
}

TEST_CASE("gate check: against a baseline five lost verdicts are a regression and four are not") {
  const Campaign baseline = good_campaign();
  Campaign campaign = baseline;
  const GateFile file = gates(campaign, "[baseline]\narchive = \"old.h5\"\nmaximum_lost = 3\n");
  CHECK(check_gates(campaign, file, &baseline).passed());
  mislocate(campaign, ExperimentKind::mpm, 3);
  CHECK(check_gates(campaign, file, &baseline).passed());
  mislocate(campaign, ExperimentKind::mpm, 4);
  GateCheck check = check_gates(campaign, file, &baseline);
  CHECK(result_of(check, "baseline.located.p_worse").outcome == GateOutcome::pass);
  CHECK(result_of(check, "baseline.located.lost").outcome == GateOutcome::fail);
  CHECK(result_of(check, "baseline.source_recognised.lost").outcome == GateOutcome::pass);
  mislocate(campaign, ExperimentKind::mpm, 5);
  check = check_gates(campaign, file, &baseline);
  CHECK(result_of(check, "baseline.located.p_worse").outcome == GateOutcome::fail);
  CHECK(check_gates(baseline, file, &campaign).passed());  // the other way round it is progress
}

TEST_CASE("gate check: an edited study is held against its baseline, and the keys that differ are named") {
  Campaign baseline = good_campaign();
  Campaign campaign = baseline;
  const std::string text = baseline.study.source;
  baseline.study = parse_study(text + "\n[diagnosis]\nmpm_threshold = 0.2\n", "before");
  campaign.study = parse_study(text + "\n[diagnosis]\nmpm_threshold = 0.3\n", "now");
  mislocate(campaign, ExperimentKind::mpm, 5);
  const GateCheck check =
      check_gates(campaign, gates(campaign, "[baseline]\narchive = \"old.h5\"\n"), &baseline);
  CHECK_FALSE(check.passed());
  REQUIRE(check.baseline->edited.size() == 1);
  CHECK_THAT(gates_text(check),
             Contains("the study was edited since:\n  diagnosis.mpm_threshold: 0.2 -> 0.3\n"));
}

TEST_CASE("gate check: a baseline of another seed, with other faults or fewer experiments is refused") {
  const Campaign campaign = good_campaign();
  const GateFile file = gates(campaign, "[baseline]\narchive = \"old.h5\"\n");
  Campaign baseline = campaign;
  baseline.study.seed = 7;
  CHECK_THROWS_WITH(check_gates(campaign, file, &baseline),
                    Contains("baseline old.h5: found runs that cannot be paired: the seeds differ, 7 and "
                             "18446744073709551615; allowed: "));
  baseline = campaign;
  baseline.records[3].draw.mismatches.clear();
  baseline.records[3].draw.disturbances.clear();
  CHECK_THROWS_WITH(check_gates(campaign, file, &baseline),
                    Contains("experiment 3 does not have the same fault in both"));
  baseline = campaign;
  baseline.records.pop_back();
  CHECK_THROWS_WITH(check_gates(campaign, file, &baseline),
                    "baseline old.h5: found 39 of the experiments that are checked; allowed: all 40");
  Campaign without_chain = made_up_campaign();
  remove_methods(without_chain, [](const std::string& name) { return name != "sse"; });
  CHECK_THROWS_WITH(check_gates(without_chain, file, &campaign), Contains("found no verdicts of the chain"));
  CHECK(check_gates(baseline, file, &campaign).passed());
}

TEST_CASE("gate check: the rates of a comparison of methods are judged as the numbers of a study are") {
  Campaign campaign = made_up_campaign();
  for (ExperimentRecord& record : campaign.records) {
    record.status = ExperimentStatus::ok;
    record.ivar_basis = Eigen::Vector2d::Ones();
    for (AssessmentRecord& said : record.assessments)
      said = plain_verdict(said.form, record.draw.index % 10 != 0, 1.0);
  }
  const auto outcome = [&](const std::string& gate) {
    const GateFile file =
        parse_gates("[[gate]]\naggregate = \"compare.sse." + gate, "g.toml", gate_findings(campaign));
    const GateResult result = check_gates(campaign, file).results.back();
    CHECK(result.measured.count == (gate.starts_with("false") ? 0 : 40));
    return result.outcome;
  };
  // 36 of 40 are flagged; Wilson's interval is 76.9 to 96.0 %.
  CHECK(outcome("detected\"\nminimum = 0.9\n") == GateOutcome::pass);
  CHECK(outcome("detected\"\nminimum = 0.91\n") == GateOutcome::fail);
  CHECK(outcome("detected\"\nminimum = 0.8\nwith_confidence = true\n") == GateOutcome::inconclusive);
  CHECK(outcome("detected\"\nminimum = 0.76\nwith_confidence = true\n") == GateOutcome::pass);
  CHECK(outcome("false_alarm_healthy\"\nmaximum = 0.1\n") == GateOutcome::inconclusive);  // no healthy loop
  CHECK_THROWS_WITH(outcome("detected\"\nminimum = 90\n"), Contains("minimum: found 90"));
  CHECK_THROWS_WITH(outcome("detekted\"\nminimum = 0.9\n"), Contains("nearest: 'compare.sse.detected'"));

  remove_methods(campaign, [](const std::string& name) { return name == "sse"; });
  CHECK_THROWS_WITH(outcome("detected\"\nminimum = 0.9\n"),
                    Contains("g.toml:2: gate[0].aggregate: found 'compare.sse.detected'"));
}

TEST_CASE("gate report: the table names the distance, the reason and the experiments that changed") {
  const Campaign baseline = good_campaign();
  Campaign campaign = baseline;
  mislocate(campaign, ExperimentKind::ud, 20);
  const GateFile file = gates(campaign, kLocated + "[baseline]\narchive = \"old.h5\"\n");
  const std::string text = gates_text(check_gates(campaign, file, &baseline));
  CHECK_THAT(text, Contains("ud.located: fail: the value, 0.0 %, misses >= 60.0 % by 60.0 pp (because)\n"));
  CHECK_THAT(text, Contains("against the baseline old.h5 (mpmbench 1.2.3 (abc+), solver ipopt)"));
  CHECK_THAT(text, Contains("      1  lost    right -> wrong\n"));
  CHECK_THAT(text, Contains("\nFAILED: "));
  CHECK_THAT(gates_text(check_gates(baseline, file, &baseline)),
             Contains("\nPASSED: 6 of 6 gates pass, 0 fail, 0 inconclusive\n"));
}

TEST_CASE("gate report: JUnit has a failure for what stops the campaign and skipped for what does not") {
  Campaign campaign = good_campaign();
  mislocate(campaign, ExperimentKind::ud, 2);
  const auto junit = [&](const std::string& text) {
    return gates_junit(check_gates(campaign, gates(campaign, text)), "<a&b>.h5");
  };
  CHECK_THAT(junit(kSure), Contains("failures=\"1\" errors=\"0\" skipped=\"0\"") &&
                               Contains("type=\"inconclusive\"") && Contains("&lt;a&amp;b>.h5"));
  CHECK_THAT(junit("inconclusive = \"pass\"\n" + kSure),
             Contains("failures=\"0\" errors=\"0\" skipped=\"1\"") && Contains("<skipped message="));
}

}  // namespace
