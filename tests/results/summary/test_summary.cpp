#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "analysis/findings/s0_perturbation_curves.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_markdown.hpp"
#include "results/document/document_text.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/sweep_document.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

const Campaign& small_sample() {
  static const Campaign campaign = campaign_sample();
  return campaign;
}

std::string text_of(const Campaign& campaign, const std::string& file = "out.h5") {
  return document_text(summary_document(campaign, findings_of(campaign), file));
}

nlohmann::json json_of(const Campaign& campaign) {
  return nlohmann::json::parse(document_json(summary_document(campaign, findings_of(campaign), "out.h5")));
}

/// Lets the chain of each experiment that has an answer say something else.
void change_chain(Campaign& campaign, const std::function<void(Diagnosis&)>& change) {
  for (ExperimentRecord& record : campaign.records) {
    Diagnosis chain = testing::diagnosis_of(record.chain());
    if (chain.ivar.size() == 0)
      continue;
    change(chain);
    set_chain(campaign.study, record, chain);
  }
}

/// The line of the text that begins with this word; empty when there is none.
std::string line_of_text(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.compare(0, word.size() + 1, word + " ") == 0)
      return line;
  return {};
}

/// A number of the JSON form: null stands for one that does not exist.
bool same(const nlohmann::json& json, double value) {
  return std::isfinite(value) ? json.is_number() && json.get<double>() == value : json.is_null();
}

TEST_CASE("summary: the text says what was run and whether the basis case is healthy") {
  const std::string text = text_of(small_sample());
  CHECK_THAT(line_of_text(text, "study"), Contains("chapter6: Shell fractionator 7x3"));
  CHECK_THAT(line_of_text(text, "plant"), Contains("shell-7x3; 7 CVs, 3 MVs, 2 MDs"));
  CHECK_THAT(line_of_text(text, "controller"), Contains("MPC with setpoints and ranges"));
  CHECK_THAT(text, Contains("horizon 75, control horizon 15"));
  CHECK_THAT(line_of_text(text, "experiments"), Contains("8 (") && Contains("1 failed"));
  CHECK_THAT(line_of_text(text, "seed"), Contains("12345678901234567890"));
  CHECK_THAT(line_of_text(text, "program"), Contains("mpmbench 0.1.0 (abcdef), solver active-set"));
  CHECK_THAT(line_of_text(text, "run"), Contains("2026-01-01T00:00:00Z, 1.5 s with 2 jobs"));
  CHECK_THAT(line_of_text(text, "self-check"), Contains("passed: Ivar of the nominal loop"));
  Campaign unhealthy = small_sample();
  unhealthy.basis.healthy = false;
  CHECK_THAT(line_of_text(text_of(unhealthy), "self-check"), Contains("FAILED"));
}

TEST_CASE("summary: a measured share stands beside the reported one with its interval") {
  // 1 of the 7 experiments that did not fail is infeasible; Wilson's interval of 1/7 is 2.6 to 51.3 %.
  const std::string line = line_of_text(text_of(small_sample()), "infeasible");
  CHECK_THAT(line,
             Contains(" 14.3 [2.6, 51.3] % ") && Contains(" 7 ") && Contains(" 4.0 % ") && Contains("yes"));
  Campaign other = small_sample();
  other.study.reported = {{"infeasible", 0.9}};
  CHECK_THAT(line_of_text(text_of(other), "infeasible"), Contains(" 90.0 %  no"));
}

TEST_CASE("summary: without reported values there is no column of them, and every number has its row") {
  Campaign campaign = made_up_campaign();
  const std::string text = text_of(campaign);
  CHECK_THAT(text, !Contains("reported"));
  for (const Finding& finding : findings_of(campaign).rows)
    if (finding.prominence != Prominence::detail && finding.group != FindingGroup::dominance &&
        finding.group != FindingGroup::method) {
      INFO(finding.name);
      CHECK_FALSE(line_of_text(text, finding.name).empty());
    }
}

TEST_CASE(
    "summary: failures have their messages, wrong verdicts the command that replays them, ten at most") {
  Campaign campaign = made_up_campaign();
  change_chain(campaign, [](Diagnosis& chain) { chain.impactful = false; });
  CHECK_THAT(text_of(campaign), Contains("0 experiments with impact got a wrong verdict\n"));

  for (std::int64_t i = 0; i < 13; ++i) {
    ExperimentRecord& record = campaign.records[static_cast<std::size_t>(i)];
    record.status = ExperimentStatus::ok;
    record.ivar_basis = Eigen::Vector2d::Ones();
    Diagnosis chain = campaign.basis.diagnosis;
    chain.impactful = true;
    chain.predicted_cv = 1 - record.draw.true_cv();
    set_chain(campaign.study, record, chain);
  }
  const std::string text = text_of(campaign);
  CHECK_THAT(text, Contains("13 experiments with impact got a wrong verdict:\n") &&
                       Contains("mpmbench replay out.h5 0\n") && Contains("mpmbench replay out.h5 9\n") &&
                       !Contains("mpmbench replay out.h5 10\n") && Contains("and 3 more"));
  CHECK(text_of(streamed_from(campaign)) == text);
  CHECK(json_of(campaign)["wrong_verdicts"].size() == 13);
  CHECK(json_of(streamed_from(campaign)) == json_of(campaign));
  CHECK_THAT(text, Contains("experiments failed:\n") && Contains("died: \xC3\xBC"));
}

TEST_CASE("summary: fits and changes of a modified S0, and S0 with MVs fixed, in both forms") {
  const std::string text = text_of(small_sample());
  CHECK_THAT(text, Contains("S_0 modified, 0.75 to 1.25 times") && Contains("S_0 with u1 fixed"));
  const nlohmann::json json = json_of(small_sample())["s0_perturbation"];
  REQUIRE(json["fits"].size() == 3);  // y1, y2, y7
  CHECK(json["fits"][2]["cv"] == "y7");
  CHECK(json["fixed_mvs"].size() == 2);
  const std::vector<S0Curve> curves = s0_curve_collector(small_sample().study).of(small_sample().records);
  REQUIRE_FALSE(curves.empty());
  REQUIRE(json["changes"].size() == curves.size());
  CHECK(json["changes"][0]["experiments"] == curves[0].experiments);
  CHECK(same(json["changes"][0]["damping"]["largest_change"], curves[0].damping_change.largest));

  const std::string without = text_of(empty_campaign());
  CHECK_THAT(without, !Contains("S_0 modified") && !Contains("fixed"));
}

TEST_CASE("summary: no line of the sample is longer than 100 columns or ends with a blank") {
  Campaign campaign = small_sample();  // without the comparison, which may be wider
  remove_methods(campaign, [](const std::string& name) { return name != "botelho"; });
  std::istringstream lines(text_of(campaign));
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    CHECK(line.size() <= 100);
    CHECK((line.empty() || line.back() != ' '));
  }
}

TEST_CASE("summary: the JSON form has the findings and the reported numbers") {
  const nlohmann::json json = json_of(small_sample());
  const StudyFindings findings = findings_of(small_sample());
  REQUIRE(json["findings"].size() == findings.rows.size());
  for (std::size_t i = 0; i < findings.rows.size(); ++i) {
    const nlohmann::json& found = json["findings"][i];
    const Finding& expected = findings.rows[i];
    CHECK(found["name"] == expected.name);
    CHECK(found["meaning"] == expected.meaning);
    CHECK(found["form"] == to_string(expected.form));
    CHECK(found["count"] == expected.count);
    CHECK(same(found["value"], expected.value));
    CHECK(same(found["lower"], expected.interval.lower));
    CHECK(same(found["upper"], expected.interval.upper));
  }
  CHECK(json["methods"] == method_names(small_sample()));
  const auto infeasible = std::find_if(json["findings"].begin(), json["findings"].end(),
                                       [](const auto& finding) { return finding["name"] == "infeasible"; });
  REQUIRE(infeasible != json["findings"].end());
  CHECK((*infeasible)["reported"] == 0.04);
  CHECK(json["dominance"].size() == findings.dominance.size());
  CHECK(json["study"] == "chapter6");
  CHECK(json["seed"].get<std::uint64_t>() == 12345678901234567890U);
  CHECK(json["experiments"] == 8);
  CHECK(json["infeasible"] == 1);
  CHECK(json["failed"] == 1);
  CHECK(json["basis"]["healthy"] == true);
  CHECK(same(json["basis"]["ivar"]["y7"], small_sample().basis.diagnosis.ivar(6)));
  CHECK(json["failures"][0]["index"] == 4);
  CHECK(json["failures"][0]["message"] == "ended by signal 9: \xC3\xBC");
}

TEST_CASE("summary: a study of named scenarios shows each with its truth and its verdict") {
  Campaign campaign = scenario_campaign();
  Diagnosis chain = testing::diagnosis_of(campaign.records[1].chain());
  std::vector<CvDiagnosis>& channels = chain.cvs;
  channels[0] = {true, FaultSource::mpm, {}, {}, 1.5};
  channels[1] = {false, FaultSource::none, {}, {}, 0.25};
  channels[0].acf.speed = LoopSpeed::slower;
  channels[0].acf.y.oscillation.verdict = Oscillation::present;
  channels[0].acf.y0.oscillation.verdict = Oscillation::absent;
  channels[0].acf.origin = ErrorOrigin::others;
  channels[0].distribution.means.dkts.ce = 0.375;
  chain.ivar_diag = Eigen::Vector2d(2.5, 1.0);
  set_chain(campaign.study, campaign.records[1], chain);
  const std::string text = text_of(campaign);
  CHECK_THAT(line_of_text(text, "experiments"),
             Contains("5 (named scenarios) of 60 samples; 1 infeasible, 1 failed"));
  CHECK_THAT(line_of_text(text, "channels"), Contains("level (MPM), heat (MPM)") &&
                                                 Contains("level (MPM) ") && Contains("1.75") &&
                                                 Contains("missed heat"));
  CHECK_THAT(line_of_text(text, "failed"), Contains("failed"));
  const std::string indicators = text.substr(text.find("Indicators of the flagged CVs"));
  const std::string acf = text.substr(text.find("Verdicts of the autocorrelation functions"));
  CHECK_THAT(line_of_text(acf, "channels"),
             Contains("level") && Contains("slower than designed, oscillates; models of other CVs"));
  const auto cv = json_of(campaign)["scenarios"][1]["cvs"][0];
  CHECK(cv["distribution"]["ce_dkts"] == 0.375);
  CHECK(cv["acf"]["loop_speed"] == "slower");
  CHECK(cv["acf"]["oscillation_y"] == "present");
  CHECK_THAT(line_of_text(indicators, "channels"), Contains("level") && Contains("1.5"));
  CHECK(indicators.find("\nchannels ") ==
        indicators.substr(0, indicators.find("Verdicts")).rfind("\nchannels "));
  CHECK_THAT(text, Contains("2.5*") && !Contains("Measured values"));

  const nlohmann::json json = json_of(campaign);
  REQUIRE(json["scenarios"].size() == 5);
  for (const auto& value : json["findings"])
    if (value["name"] == "right_scenarios") {
      CHECK(value["count"] == 3);
      CHECK(value["value"].get<double>() < 1.0);  // "channels" is missed
    }
  const nlohmann::json& found = json["scenarios"][1];
  CHECK(found["name"] == "channels");
  CHECK(found["description"] == "<b> 'all' & more");
  CHECK(found["affected"] == nlohmann::json{{"level", "mpm"}, {"heat", "mpm"}});
  CHECK(found["verdict"] == "missed heat");
  CHECK(found["tsse"] == 1.75);
  CHECK(found["cvs"][0]["flagged"] == true);
  CHECK(found["cvs"][0]["ivar_diag"] == 2.5);
  CHECK(found["cvs"][1]["source"] == "none");
  CHECK(json["scenarios"][3]["tsse"].is_null());
  CHECK(json_of(small_sample())["scenarios"].empty());
}

TEST_CASE("summary: healthy experiments and bad tunings are counted, and their alarms are wrong verdicts") {
  Campaign campaign = faultless_campaign();
  change_chain(campaign, [](Diagnosis& chain) { chain.impactful = false; });
  ExperimentRecord& healthy =
      *std::find_if(campaign.records.begin(), campaign.records.end(), [](const auto& record) {
        return record.draw.kind == ExperimentKind::healthy && record.status == ExperimentStatus::ok;
      });
  Diagnosis chain = testing::diagnosis_of(healthy.chain());
  chain.impactful = true;
  chain.predicted_cv = 1;
  chain.predicted_source = FaultSource::mpm;
  set_chain(campaign.study, healthy, chain);
  const std::string text = text_of(campaign);
  CHECK_THAT(line_of_text(text, "experiments"), Contains("9 MPM, 6 UD, 9 healthy, 24 tuning"));
  CHECK_THAT(text, Contains("1 experiment with impact got a wrong verdict") &&
                       Contains("healthy  none     heat     MPM"));
  const nlohmann::json json = json_of(campaign);
  CHECK(json["kinds"] == nlohmann::json{{"mpm", 9}, {"ud", 6}, {"healthy", 9}, {"tuning", 24}});
  CHECK(json["wrong_verdicts"] == nlohmann::json{healthy.draw.index});
  for (const auto& value : json["findings"])
    if (value["name"] == "false_mpm_healthy")
      CHECK(value["value"].get<double>() == Approx(1.0 / value["count"].get<double>()));
}

TEST_CASE("summary: several methods are compared, and one is not") {
  Campaign campaign = made_up_campaign();
  CHECK_THAT(text_of(campaign),
             Contains(document_text(comparison_document(campaign, findings_of(campaign)))));
  remove_methods(campaign, [](const std::string& name) { return name != "botelho"; });
  CHECK_THAT(text_of(campaign), !Contains("experiments compared"));
  CHECK(json_of(campaign)["methods"] == nlohmann::json{"botelho"});
}

TEST_CASE("summary: a campaign without the chain says nothing of it, and all that the others say") {
  Campaign campaign =
      GENERATE(made_up_campaign(), faultless_campaign(), scenario_campaign(), empty_campaign());
  remove_methods(campaign, [](const std::string& name) { return name == "botelho"; });
  const std::string text = text_of(campaign);
  CHECK_THAT(text, !Contains("wrong verdict") && !Contains("I_MPM") && !Contains("botelho") &&
                       Contains(document_text(comparison_document(campaign, findings_of(campaign)))));
  const nlohmann::json json = json_of(campaign);
  CHECK(json["wrong_verdicts"].empty());
  CHECK(json["dominance"].empty());
  for (const nlohmann::json& finding : json["findings"])
    CHECK_THAT(finding["name"].get<std::string>(), !Contains("i_mpm") && !Contains("botelho"));
}

TEST_CASE("summary: infinite and missing numbers and broken texts still make valid JSON") {
  Campaign campaign = made_up_campaign();
  campaign.info.command = "\xFF";
  const nlohmann::json json = json_of(campaign);
  CHECK(json["run"]["command"] == "\xEF\xBF\xBD");
  CHECK(json["findings"][0]["reported"].is_null());
  CHECK(json_of(empty_campaign())["experiments"] == 0);
  CHECK_THAT(text_of(empty_campaign()), Contains("0 experiments with impact"));
}

TEST_CASE("sweep: one table in Markdown and JSON, with the studies that could not be run") {
  Finding share{.name = "mpm.located", .label = "CV located", .meaning = "", .form = FindingForm::share};
  share.prominence = Prominence::headline;
  Finding index{.name = "r_squared", .label = "R of I_{MPM}", .meaning = ""};
  index.prominence = Prominence::headline;
  Finding other{.name = "count", .label = "count", .meaning = ""};
  const std::vector<SweepRow> rows{
      {"", "", true, "", {share.with(0.985, {0.916, 0.997}, 68), index.with(0.5, {0.25, 0.75}, 68), other}},
      {"noise", "less", false, "", {share.with(kNaN, {kNaN, kNaN}, 0), index.with(0.25, {0.0, 1.0}, 2)}},
      {"noise", "wild", true, "no basis", {}}};
  const Document document = sweep_document("Noise", rows);
  CHECK(document_markdown(document) ==
        "| choice | value | CV located, % | R of I_MPM |\n|---|---|---|---|\n"
        "| as shipped |  | 98.5 (92 to 100) | 0.50 (0.25 to 0.75) |\n"
        "| noise | less * | - | 0.25 (0.00 to 1.00) |\n"
        "|  | wild | - | - |\n"
        "\nnot run: noise = wild: no basis\n");
  const nlohmann::json json = nlohmann::json::parse(document_json(document));
  CHECK(json["title"] == "Noise");
  REQUIRE(json["studies"].size() == 3);
  CHECK(json["studies"][0]["findings"]["mpm.located"] ==
        nlohmann::json{{"value", 0.985}, {"lower", 0.916}, {"upper", 0.997}, {"count", 68}});
  CHECK(json["studies"][1]["choice"] == "noise");
  CHECK(json["studies"][1]["healthy"] == false);
  CHECK(json["studies"][1]["findings"]["mpm.located"]["value"].is_null());
  CHECK(json["studies"][2]["trouble"] == "no basis");
  CHECK(json["studies"][2]["findings"].empty());
}

}  // namespace
