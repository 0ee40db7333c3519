#include <cmath>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/method_words.hpp"
#include "results/summary/comparison.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
using Json = nlohmann::json;

/// Four methods, which is more than stand side by side in one table of the text: those of the table from its
/// start, again and again.
Campaign four_methods() {
  Campaign campaign = made_up_campaign();
  Comparison& comparison = *campaign.comparison;
  const std::vector<std::string> known = assessment_method_names();
  comparison.methods.clear();
  comparison.reasons = {"", "it needs <more>", "", ""};
  for (std::size_t method = 0; method < 4; ++method)
    comparison.methods.push_back(known[method % known.size()]);
  MethodVerdict answer;
  answer.status = AssessmentStatus::ok;
  answer.flagged = true;
  answer.score = 0.5;
  answer.seconds = 0.001;
  for (ComparedLoop& loop : comparison.loops) {
    loop.verdicts.assign(4, answer);
    loop.verdicts[0].flagged = loop.experiment % 4 != 0;
    loop.verdicts[1].status = loop.experiment < 10 ? AssessmentStatus::ok : AssessmentStatus::not_applicable;
  }
  return campaign;
}

TEST_CASE(
    "comparison text: rates, intervals, reasons and pairs stand there; no line is wider than a terminal") {
  const Campaign campaign = four_methods();
  const std::string text = comparison_text(campaign);
  const ComparisonSummary summary = summarise(*campaign.comparison, campaign.records, campaign.study);
  const Rate& detected = summary.methods[0].detected;
  CHECK(detected.hits < detected.total);
  CHECK_THAT(text,
             Contains(std::to_string(campaign.comparison->loops.size()) + " of 40 experiments compared"));
  for (const MethodRateInfo& info : method_rate_infos())
    CHECK_THAT(text, Contains(std::string("\n") + info.title));
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

TEST_CASE("comparison text: one method has no pairs, and what was not counted is a dash") {
  Campaign campaign = four_methods();
  Comparison& comparison = *campaign.comparison;
  comparison.methods.resize(1);
  comparison.reasons.resize(1);
  for (ComparedLoop& loop : comparison.loops)
    loop.verdicts.resize(1);
  const std::string text = comparison_text(campaign);
  CHECK_THAT(text, !Contains("McNemar") && !Contains("because") && Contains("false alarms, bad tuning"));
  const std::size_t line = text.find("false alarms, bad tuning");
  CHECK(text.substr(0, text.find('\n', line)).ends_with(" -"));
}

TEST_CASE("comparison JSON: every rate, curve and pair, the same numbers as the summary") {
  Campaign campaign = four_methods();
  campaign.records[0].draw = {};  // a healthy one, so that there is a curve
  campaign.records[0].draw.index = 0;
  const ComparisonSummary summary = summarise(*campaign.comparison, campaign.records, campaign.study);
  const Json json = Json::parse(comparison_json(campaign));
  CHECK(json["loops"] == campaign.comparison->loops.size());
  REQUIRE(json["methods"].size() == 4);
  for (std::size_t m = 0; m < 4; ++m) {
    const MethodRates& method = summary.methods[m];
    const Json& of_json = json["methods"][m];
    CHECK(of_json["name"] == method.method);
    CHECK(of_json["reason"] == method.reason);
    CHECK(of_json["rates"].size() == method_rate_infos().size());
    for (const MethodRateInfo& info : method_rate_infos()) {
      const Rate& rate = method.*info.rate;
      const Json& share = of_json["rates"][info.name];
      CHECK(share["hits"] == rate.hits);
      CHECK(share["total"] == rate.total);
      if (rate.total > 0)
        CHECK(share["value"] == rate.value);
      else
        CHECK(share["value"].is_null());
      CHECK(share["lower"] == rate.interval.lower);
      CHECK(share["upper"] == rate.interval.upper);
      CHECK(json["rates"][info.name] == info.meaning);
    }
    CHECK(of_json["roc"]["threshold"].size() == method.roc.points.size());
  }
  REQUIRE(summary.methods[0].roc.defined());
  CHECK(json["methods"][0]["roc"]["area"] == summary.methods[0].roc.area);
  CHECK(json["methods"][0]["roc"]["threshold"][0].is_null());  // infinity
  CHECK(json["methods"][0]["milliseconds"] == summary.methods[0].milliseconds);
  REQUIRE(json["pairs"].size() == 12);
  CHECK(json["pairs"][0]["truth"] == "fault");
  CHECK(json["pairs"][6]["truth"] == "impact");
  CHECK(json["pairs"][0]["second"] == summary.methods[1].method);
  CHECK(json["pairs"][0]["loops"] == summary.pairs[0].loops);
  CHECK(json["pairs"][0]["first_alone"] == summary.pairs[0].test.lost);
  CHECK(json["pairs"][0]["p_two_sided"] == summary.pairs[0].test.p_two_sided);
}

TEST_CASE("comparison words: what a method needs and tells") {
  AssessmentMethodInfo method;
  CHECK(needs_text(method) == "nothing else");
  CHECK(answers_text(method) == "nothing else");
  method.requirements = {.setpoints = true, .moving_setpoints = true, .benchmark = true};
  method.locates_cvs = method.tells_sources = true;
  CHECK(needs_text(method) == "setpoints that move, a benchmark period");
  CHECK(answers_text(method) == "the CV, the source");
}

}  // namespace
