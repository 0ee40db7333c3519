#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_markdown.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_document.hpp"
#include "results/gates/gate_report.hpp"
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

/// The made-up campaign under the chain and a method from outside, which says as the chain does whether there
/// is a fault.
Campaign campaign_of_two(const std::string& options) {
  Campaign campaign = good_campaign();
  MethodDescription description;
  description.name = description.title = "mine";
  description.verdict = "as it means it";
  description.origin = "program python3 mine.py";
  description.given_options = options;
  description.fingerprint = "python3 mine.py (mine.py 12ab), options " + options;
  const auto form = std::make_shared<AssessmentForm>(description, campaign.study);
  campaign.methods.push_back({form, "1.2.3", "abc", "mpmbench run"});
  for (ExperimentRecord& record : campaign.records)
    record.assessments.push_back(record.status == ExperimentStatus::ok
                                     ? plain_verdict(form, !is_faultless(record.draw.kind), 1.0)
                                     : unasked(form));
  return campaign;
}

AssessmentRecord& said_by_mine(ExperimentRecord& record) {
  return record.assessments.back();
}

TEST_CASE("gate check: every method of both archives is held against its baseline") {
  const Campaign baseline = campaign_of_two("{\"limit\": 1.5, \"of\": {\"window\": 20}}");
  Campaign campaign = campaign_of_two("{\"limit\": 30.0, \"of\": {\"window\": 20}}");
  const GateFile file = gates(campaign, "[baseline]\narchive = \"old.h5\"\nmaximum_lost = 0\n");
  CHECK(check_gates(campaign, file, &baseline).passed());
  int silenced = 0;
  for (ExperimentRecord& record : campaign.records)
    if (said_by_mine(record).flagged && silenced < 7) {
      said_by_mine(record).flagged = false;
      ++silenced;
    }
  REQUIRE(silenced == 7);
  const GateCheck check = check_gates(campaign, file, &baseline);
  CHECK_FALSE(check.passed());
  CHECK(result_of(check, "baseline.mine.flag_fault.lost").measured.value == 7.0);
  CHECK(result_of(check, "baseline.mine.flag_fault.lost").outcome == GateOutcome::fail);
  CHECK(result_of(check, "baseline.located.lost").outcome == GateOutcome::pass);
  CHECK(result_of(check, "baseline.botelho.flag_fault.lost").outcome == GateOutcome::pass);
  const std::string text = gates_text(check);
  CHECK_THAT(text, Contains("changed since:\n  method.mine.options.limit: 1.5 -> 30.0\n") &&
                       !Contains("window") && !Contains("method.mine.command"));
  CHECK_THAT(text, Contains("mine: flag, fault: 7 lost, 0 gained among "));
}

TEST_CASE("gate check: p-values are corrected for the questions of which a verdict changed") {
  const Campaign baseline = campaign_of_two("{}");
  Campaign campaign = baseline;
  const GateFile file = gates(campaign, "[baseline]\narchive = \"old.h5\"\n");
  mislocate(campaign, ExperimentKind::mpm, 5);
  CHECK(result_of(check_gates(campaign, file, &baseline), "baseline.located.p_worse").measured.value ==
        Approx(0.03125));
  // A second question that loses five: each may have lost them by chance.
  int changed = 0;
  for (ExperimentRecord& record : campaign.records)
    if (changed < 5 && said_by_mine(record).flagged) {
      said_by_mine(record).flagged = false;
      ++changed;
    }
  REQUIRE(changed == 5);
  const GateCheck check = check_gates(campaign, file, &baseline);
  std::size_t questions = 0;
  for (const BaselineChanges& question : check.baseline->questions)
    questions += question.changed() ? 1 : 0;
  CHECK(questions >= 2);
  CHECK(result_of(check, "baseline.located.p_worse").measured.value ==
        Approx(0.03125 * static_cast<double>(questions)));
  CHECK(result_of(check, "baseline.located.p_worse").outcome == GateOutcome::pass);
}

TEST_CASE("gate check: a method from outside has to answer, unless the file says otherwise") {
  Campaign campaign = campaign_of_two("{}");
  CHECK(result_of(check_gates(campaign, gates(campaign, kLocated)), "answered.mine").measured.value == 1.0);
  std::int64_t asked = 0, failed = 0;
  for (ExperimentRecord& record : campaign.records)
    if (said_by_mine(record).answered()) {
      ++asked;
      said_by_mine(record) = unasked(record.assessments.back().form);
      said_by_mine(record).status =
          asked % 4 == 0 ? AssessmentStatus::failed : AssessmentStatus::not_applicable;
      said_by_mine(record).reason = asked % 4 == 0 ? "singular\nPASSED" : "no setpoints";
      failed += asked % 4 == 0 ? 1 : 0;
      if (asked % 4 > 1)
        said_by_mine(record) = plain_verdict(record.assessments.back().form, true, 1.0);
    }
  const GateCheck check = check_gates(campaign, gates(campaign, kLocated));
  const GateResult& answers = result_of(check, "answered.mine");
  CHECK(answers.outcome ==
        GateOutcome::fail);  // a loop to which it does not apply is no failure, nor an answer
  CHECK(answers.measured.count < asked);
  CHECK(answers.measured.hits == answers.measured.count - failed);
  CHECK_THAT(gates_text(check),
             Contains("answered.mine: fail: ") && Contains(", first with: singular PASSED"));
  CHECK(check_gates(campaign, gates(campaign, "minimum_answered = 0.6\n" + kLocated)).passed());
  for (const CampaignMethod& method : campaign.methods)  // methods of this program fail as they do
    if (method.form->method().origin.empty())
      for (const GateResult& result : check.results)
        CHECK(result.gate.name != "answered." + method.form->method().name);
  for (ExperimentRecord& record : campaign.records)
    if (said_by_mine(record).status != AssessmentStatus::not_assessed) {
      said_by_mine(record) = unasked(record.assessments.back().form);
      said_by_mine(record).status = AssessmentStatus::not_applicable;
    }
  const GateCheck unasked_check = check_gates(campaign, gates(campaign, kLocated));
  CHECK(unasked_check.passed());  // it was asked on no loop
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
  CHECK_THAT(gates_text(check), Contains("changed since:\n  diagnosis.mpm_threshold: 0.2 -> 0.3\n"));
  CHECK_THAT(gates_junit(check, "a.h5"),
             Contains("name=\"changed since: diagnosis.mpm_threshold\" value=\"0.2 -&gt; 0.3\"") ||
                 Contains("name=\"changed since: diagnosis.mpm_threshold\" value=\"0.2 -> 0.3\""));
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
  CHECK_THROWS_WITH(
      check_gates(without_chain, file, &campaign),
      Contains("baseline old.h5: found verdicts of botelho; allowed: those of one of the methods that are "
               "checked: sse"));
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
  CHECK_THAT(gates_text(check_gates(baseline, file, &baseline)), Contains("\nno verdict changed: ") &&
                                                                     Contains("\nPASSED: ") &&
                                                                     Contains(" 0 fail, 0 inconclusive\n"));
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

TEST_CASE("gate report: the names in JUnit outlive their limits, and times add up") {
  Campaign campaign = good_campaign();
  campaign.info.created = "2026-11-29T09:55:16Z";
  campaign.info.seconds = 6.25;
  const auto names = [&](const std::string& text) {
    pugi::xml_document document;
    REQUIRE(document.load_string(gates_junit(check_gates(campaign, gates(campaign, text)), "a.h5").c_str()));
    const pugi::xml_node suite = document.child("testsuites").child("testsuite");
    CHECK(suite.attribute("timestamp").value() == campaign.info.created);
    CHECK(suite.attribute("time").as_double() == 6.25);
    std::vector<std::string> found;
    double seconds = 0.0;
    for (const pugi::xml_node test_case : suite.children("testcase")) {
      found.emplace_back(test_case.attribute("name").value());
      seconds += test_case.attribute("time").as_double();
    }
    CHECK(seconds == 6.25);
    return found;
  };
  const std::string upper = "[[gate]]\naggregate = \"ud.located\"\nmaximum = 1.0\n";
  const std::vector<std::string> expected{"self_check", "experiments", "failed", "ud.located",
                                          "ud.located (2)"};
  CHECK(names(kLocated + upper) == expected);
  CHECK(names("[[gate]]\naggregate = \"ud.located\"\nminimum = 0.1\nwith_confidence = true\n" + upper) ==
        expected);
}

TEST_CASE("gate report: JSON and Markdown have every gate and every verdict that changed") {
  const Campaign baseline = good_campaign();
  Campaign campaign = baseline;
  mislocate(campaign, ExperimentKind::ud, 20);
  const GateFile file = gates(campaign, kLocated + "[baseline]\narchive = \"old.h5\"\n");
  const GateCheck check = check_gates(campaign, file, &baseline);
  const Document document = gates_document(check, "a.h5");
  const auto json = nlohmann::json::parse(document_json(document));
  CHECK(json["passed"] == false);
  CHECK(json["archive"] == "a.h5");
  REQUIRE(json["gates"].size() == check.results.size());
  CHECK(json["gates"][3]["name"] == "ud.located");
  CHECK(json["gates"][3]["minimum"] == 0.6);
  CHECK(json["gates"][3]["maximum"].is_null());
  CHECK(json["gates"][3]["value"] == 0.0);
  CHECK(json["gates"][3]["outcome"] == "fail");
  CHECK(json["gates"][3]["stops"] == true);
  const auto& questions = json["baseline"]["questions"];
  const auto located = std::find_if(questions.begin(), questions.end(),
                                    [](const nlohmann::json& each) { return each["name"] == "located"; });
  REQUIRE(located != questions.end());
  REQUIRE((*located)["lost"].size() > 5);
  CHECK((*located)["lost"][0]["index"] == 1);
  CHECK((*located)["lost"][0]["now"] == "wrong");

  const std::string markdown = document_markdown(document);
  CHECK_THAT(markdown, Contains(": FAILED: ") && Contains("\n\n| gate | limit |") &&
                           Contains("| ud.located | \\>= 60.0 % | value | 0.0 % |") &&
                           Contains("\n\n- ud.located: fail: ") && Contains("| lost | gained |"));
  CHECK_THAT(stopped_text(check), Contains("ud.located: fail: ") && Contains("\nFAILED: "));
  CHECK_THAT(document_markdown(gates_document(check_gates(baseline, file, &baseline), "a.h5")),
             Contains("PASSED: ") && Contains("No verdict changed."));
  CHECK(stopped_text(check_gates(baseline, file, &baseline)).empty());
}

TEST_CASE("gate report: a badge is green, yellow or red") {
  Campaign campaign = good_campaign();
  const auto badge = [&](const std::string& text) {
    return nlohmann::json::parse(gates_badge(check_gates(campaign, gates(campaign, text))));
  };
  CHECK(badge(kSure)["schemaVersion"] == 1);
  CHECK(badge(kSure)["message"] == "4 of 4 gates");
  CHECK(badge(kSure)["color"] == "brightgreen");
  mislocate(campaign, ExperimentKind::ud, 2);
  CHECK(badge(kSure)["color"] == "red");
  CHECK(badge("inconclusive = \"pass\"\n" + kSure)["color"] == "yellow");
  CHECK(badge("inconclusive = \"pass\"\n" + kSure)["message"] == "3 of 4 gates");
}

}  // namespace
