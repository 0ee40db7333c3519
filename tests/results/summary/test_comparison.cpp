#include <algorithm>
#include <cmath>
#include <memory>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_words.hpp"
#include "base/non_finite.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"
#include "results/summary/comparison.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
using Json = nlohmann::json;

/// Four methods, which is more than stand side by side in one table of the text. Every loop that ran to its
/// end is flagged by all of them, but for some by the first one; the second one does not apply to some.
Campaign four_methods() {
  Campaign campaign = made_up_campaign();
  remove_methods(campaign, [](const std::string& name) {
    return name != "botelho" && name != "sun" && name != "badwe2009" && name != "badwe2010";
  });
  REQUIRE(campaign.methods.size() == 4);
  for (ExperimentRecord& record : campaign.records) {
    if (record.status != ExperimentStatus::ok)
      continue;
    for (AssessmentRecord& said : record.assessments) {
      said = plain_verdict(said.form, true, 0.5);
      said.milliseconds = 1.0;
    }
    record.assessments[0].flagged = record.draw.index % 4 != 0;
    if (record.draw.index >= 10)
      record.assessments[1] = kept(record.assessments[1].form, Assessment::not_applicable("it needs <more>"));
  }
  return campaign;
}

std::int64_t experiments_that_ran(const Campaign& campaign) {
  return std::count_if(campaign.records.begin(), campaign.records.end(),
                       [](const auto& record) { return record.status == ExperimentStatus::ok; });
}

TEST_CASE(
    "comparison text: rates, intervals, reasons and pairs stand there; no line is wider than a terminal") {
  const Campaign campaign = four_methods();
  const StudyFindings findings = findings_of(campaign);
  const std::string text = document_text(comparison_document(campaign, findings));
  const Rate& detected = findings.methods[0].rates["detected"];
  CHECK(detected.hits < detected.total);
  CHECK_THAT(text, Contains(std::to_string(experiments_that_ran(campaign)) + " of 40 experiments compared"));
  for (const RateRow* const row : counted_rates(findings.methods))
    CHECK_THAT(text, Contains(std::string("\n") + row->heading));
  CHECK_THAT(text, !Contains("calibrated"));
  char share[16];
  std::snprintf(share, sizeof share, "%.1f [%.1f, ", 100.0 * detected.value, 100.0 * detected.interval.lower);
  CHECK_THAT(text, Contains(share));
  CHECK_THAT(text, Contains("loops, the first because: it needs <more>"));
  CHECK_THAT(text, Contains("McNemar's exact test"));
  std::size_t start = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', start)) {
    CHECK(end - start <= 110);
    start = end + 1;
  }
}

TEST_CASE("comparison text: without the rest, a screen with one row a method that has a verdict") {
  const Campaign campaign = four_methods();
  const StudyFindings findings = findings_of(campaign);
  const std::string text = document_text(comparison_document(campaign, findings), kTerminalWidth, false);
  CHECK(std::count(text.begin(), text.end(), '\n') <= 20);
  const Rate& located = findings.methods[0].rates["located"];
  REQUIRE(located.total > 0);
  CHECK_THAT(text, Contains(fmt::format("{:.0f} [{:.0f}, {:.0f}]", 100 * located.value,
                                        100 * located.interval.lower, 100 * located.interval.upper)));
  for (const MethodFindings& method : findings.methods)
    CHECK_THAT(text, Contains("\n" + method.name() + " "));
  CHECK_THAT(text, !Contains("Healthy flagged") && Contains("No loop was healthy"));
  CHECK_THAT(text, !Contains("McNemar") && Catch::EndsWith("\nMore with --full.\n"));
}

TEST_CASE("comparison text: the best method stands first, and one of the user is told of by name") {
  Campaign campaign = four_methods();
  const auto set = [&campaign](std::size_t method, bool flagged) {
    for (ExperimentRecord& record : campaign.records)
      if (record.status == ExperimentStatus::ok)
        record.assessments[method] = plain_verdict(record.assessments[method].form, flagged, 0.5);
  };
  for (const std::size_t worse : {0, 1, 2})
    set(worse, false);
  set(3, true);
  MethodDescription own = campaign.methods[2].form->method();
  own.origin = "program mine";
  campaign.methods[2].form = std::make_shared<AssessmentForm>(own, campaign.study);
  const std::string text =
      document_text(comparison_document(campaign, findings_of(campaign)), kTerminalWidth, false);
  const auto place = [&](std::size_t method) {
    return text.find("\n" + campaign.methods[method].form->method().name + " ");
  };
  REQUIRE(place(3) != std::string::npos);
  CHECK((place(3) < place(0) && place(0) < place(2)));
  CHECK_THAT(text, Contains(own.name + " flags 0.0 %") && !Contains("sun flags"));
}

TEST_CASE("comparison text: one method has no pairs, and what was not counted is left out") {
  Campaign campaign = four_methods();
  remove_methods(campaign, [](const std::string& name) { return name != "botelho"; });
  const std::string text = document_text(comparison_document(campaign, findings_of(campaign)));
  CHECK_THAT(text, !Contains("McNemar") && !Contains("because") && !Contains("Bad tuning flagged"));
}

TEST_CASE("comparison JSON: every rate, curve and pair, the same numbers as the findings") {
  Campaign campaign = four_methods();
  campaign.records[0].draw = {};  // a healthy one, so that there is a curve
  const StudyFindings findings = findings_of(campaign);
  const Json json = Json::parse(document_json(comparison_document(campaign, findings)));
  CHECK(json["loops"] == experiments_that_ran(campaign));
  REQUIRE(json["methods"].size() == 4);
  for (std::size_t m = 0; m < 4; ++m) {
    const MethodRates& rates = findings.methods[m].rates;
    const Json& of_json = json["methods"][m];
    CHECK(of_json["name"] == findings.methods[m].name());
    CHECK(of_json["reason"] == rates.reason);
    CHECK(of_json["rates"].size() == rows_for(campaign.study, rate_rows()).size());
    for (const RateRow& row : rows_for(campaign.study, rate_rows())) {
      const Rate& rate = rates.rates.of(row);
      const Json& share = of_json["rates"][row.name];
      CHECK(share["hits"] == rate.hits);
      CHECK(share["total"] == rate.total);
      if (rate.total > 0)
        CHECK(share["value"] == rate.value);
      else
        CHECK(share["value"].is_null());
      CHECK(share["lower"] == rate.interval.lower);
      CHECK(share["upper"] == rate.interval.upper);
      CHECK(json["rates"][row.name] == row.meaning);
    }
    CHECK(of_json["roc"]["threshold"].size() == rates.roc.size);
  }
  const MethodRates& first = findings.methods[0].rates;
  REQUIRE(first.roc.defined());
  CHECK(json["methods"][0]["roc"]["area"] == first.roc.area);
  CHECK(json["methods"][0]["roc"]["threshold"][0].is_null());  // infinity
  CHECK(json["methods"][0]["milliseconds"] == first.milliseconds);
  REQUIRE(json["pairs"].size() == 12);
  CHECK(json["pairs"][0]["truth"] == "fault");
  CHECK(json["pairs"][6]["truth"] == "impact");
  CHECK(json["pairs"][0]["second"] == findings.methods[1].name());
  CHECK(json["pairs"][0]["loops"] == findings.pairs[0].loops);
  CHECK(json["pairs"][0]["first_alone"] == findings.pairs[0].test.lost);
  CHECK(json["pairs"][0]["p_two_sided"] == findings.pairs[0].test.p_two_sided);
  CHECK(json["pairs"][0]["p_holm"] == findings.pairs[0].p_holm);
  CHECK_FALSE(json.contains("calibration"));
}

TEST_CASE("comparison of a study with a calibration: its rates, thresholds, and where loops are too few") {
  Campaign campaign = four_methods();
  campaign.records[0].draw = {};  // a healthy one
  campaign.study.calibration.emplace();
  campaign.study.calibration->healthy = 30;
  campaign.calibration = {77,
                          std::vector(30, CalibrationLoop{ExperimentKind::healthy, {0.25, 0.5, kNaN, 0.5}})};
  const StudyFindings findings = findings_of(campaign);
  const std::string text = document_text(comparison_document(campaign, findings));
  for (const RateRow* const row : counted_rates(findings.methods))
    CHECK_THAT(text, Contains(std::string("\n") + row->heading));
  CHECK_THAT(text, Contains("Thresholds from 30 healthy loops and 100 with a disturbance, seed 77"));
  CHECK_THAT(text, Contains("no threshold_01 for botelho: 30 calibration loops with a verdict are too few"));
  CHECK_THAT(text, Contains("badwe2009: no verdict on any calibration loop, so no rate at"));
  CHECK_THAT(text, !Contains("no threshold_05 for badwe2009"));
  CHECK_THAT(text, !Contains("no threshold_05 for sun"));
  const Json json = Json::parse(document_json(comparison_document(campaign, findings)));
  CHECK(json["calibration"]["seed"] == 77);
  CHECK(json["calibration"]["loops"] == 30);
  CHECK(json["methods"][2]["unanswered"].contains("calibration"));
  CHECK(json["methods"][0]["unanswered"].empty());
  const Json& first = json["methods"][0];  // every score is 0.5: above 0.25, and above no 0.5
  CHECK(first["thresholds"]["threshold_05"]["value"] == 0.25);
  CHECK(first["thresholds"]["threshold_01"]["value"].is_null());
  CHECK(first["rates"]["power_05"]["hits"] == first["rates"]["detected"]["total"]);
  CHECK(first["rates"]["power_01"]["total"] == 0);
  CHECK(json["methods"][1]["rates"]["power_05"]["hits"] == 0);
  CHECK(first["false_alarm_mark"] == "");  // one loop says nothing
}

TEST_CASE("comparison words: what a method needs and tells") {
  AssessmentMethodInfo method;
  CHECK(needs_text(method) == "every sample");
  CHECK(answers_text(method) == "nothing else");
  method.requirements = {.setpoints = true, .moving_setpoints = true, .benchmark = true};
  method.locates_cvs = method.tells_sources = true;
  CHECK(needs_text(method) == "setpoints that move, a benchmark period, every sample");
  CHECK(answers_text(method) == "the CV, the source");
}

}  // namespace
