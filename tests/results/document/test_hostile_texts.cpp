// What others write reaches every writer: names and texts of studies, archives, boards, methods and files.
// Each writer gets texts that would be markup, macros, formulas or further lines in what it writes.

#include <charconv>
#include <memory>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/findings/loop_outcome.hpp"
#include "results/archive/csv_table.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_markdown.hpp"
#include "results/files/csv_text.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_document.hpp"
#include "results/gates/gate_report.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/change_report.hpp"
#include "results/report/report.hpp"
#include "results/suite/board_columns.hpp"
#include "results/suite/leaderboard_output.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/sweep_document.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

/// Begins as a formula does, and goes on with what ends a text in HTML, XML, LaTeX, Markdown and CSV.
std::string hostile(char first) {
  return first +
         std::string(
             "1+x0\"' onx0=\"'><x0 a>\\x0{x0%x0&x0$x0#x0|x0`x0*x0[x0](x0),;\n=x0\r\x1b[31m\xE2\x80\xAE\xFF");
}

/// Is nothing of it an element, or an attribute of one? In HTML and in SVG within it.
void check_html(const std::string& page) {
  CHECK_THAT(page, Contains("1+x0") && !Contains("<x0") && !Contains("\x1b"));
  std::smatch element;
  const bool has_attribute = std::regex_search(
      page, element, std::regex("<[a-zA-Z][^<>]*=\"[^<>\"]*\" onx0=|<[a-zA-Z][^<>]*='[^<>']*' onx0="));
  CAPTURE(element.str());
  CHECK_FALSE(has_attribute);
}

bool is_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Every line has the fields of the heading, and no field is a formula.
void check_csv(const std::string& table) {
  std::string text = table;
  // The reader for files of others takes no field over several lines, so that a quoted line end is taken out
  // here.
  bool quoted = false;
  for (char& c : text) {
    quoted = quoted != (c == '"');
    if (quoted && (c == '\n' || c == '\r'))
      c = ' ';
  }
  CsvReader reader(text, "table.csv", {.separator = ","});
  std::vector<std::string> fields = reader.heading();
  do
    for (const std::string& field : fields)
      if (!field.empty() && std::string("=+-@").find(field.front()) != std::string::npos) {
        CAPTURE(field);
        CHECK(is_number(field));
      }
  while (reader.next(fields));
}

void check_latex(const std::string& table) {
  CHECK_THAT(table, Contains("1+x0") && Contains("\\textbackslash{}x0\\{x0\\%x0\\&x0\\$x0\\#x0") &&
                        !Contains("\n=x0"));
}

void check_markdown(const std::string& table) {
  CHECK_THAT(table, Contains("1+x0") &&
                        Contains("\\<x0 a\\>\\\\x0{x0%x0\\&x0\\$x0#x0\\|x0\\`x0\\*x0\\[x0\\](x0)") &&
                        !Contains("\n=x0"));
}

/// All texts of a campaign that somebody else may have written.
Campaign hostile_campaign(char first) {
  const std::string text = hostile(first);
  Campaign campaign = made_up_campaign();
  Study& study = campaign.study;
  study.aggregate.bootstrap_replications = 100;
  for (std::string* const each :
       {&study.title, &study.plant.title, &study.plant.name, &study.plant.time_unit, &campaign.info.command,
        &campaign.info.created, &campaign.info.git_sha, &campaign.info.mpmbench_version,
        &campaign.info.outside_files, &campaign.info.solver, &campaign.basis.explanation})
    *each = text;
  int number = 0;
  for (auto* const group : {&study.plant.cvs, &study.plant.mvs, &study.plant.mds})
    for (PlantModel::Variable& variable : *group) {
      variable.name = text + std::to_string(++number);
      variable.unit = variable.description = text;
    }
  for (CampaignMethod& method : campaign.methods) {
    MethodDescription description = method.form->method();
    const bool diagnoses = description.name == "botelho";
    for (std::string* const each : {&description.title, &description.verdict, &description.origin,
                                    &description.fingerprint, &description.given_options})
      *each = text;
    description.name = text + std::to_string(++number);
    for (std::string* const each : {&method.command, &method.git_sha, &method.mpmbench_version})
      *each = text;
    const auto old = method.form;
    if (!diagnoses)  // numbers of the chain are found by its form
      method.form = std::make_shared<AssessmentForm>(description, study);
    for (ExperimentRecord& record : campaign.records)
      for (AssessmentRecord& said : record.assessments)
        if (said.form == old) {
          said.form = method.form;
          if (!said.answered() && said.status != AssessmentStatus::not_assessed)
            said.reason = text;
        }
  }
  return campaign;
}

Leaderboard hostile_board(char first) {
  const std::string text = hostile(first);
  constexpr OutcomeScope kScope{.locates_cvs = true, .tells_sources = true, .at_05 = true, .is_told = true};
  CellScores cell{.time_unit = text,
                  .monitored = true,
                  .experiments = 4,
                  .truths = LoopTruths(4, FaultTruth{ExperimentKind::mpm, true, true})};
  cell.worlds = {0, 0, 1, 1};
  cell.in_worlds = true;
  for (const LoopOutcome& said :
       {LoopOutcome{.answered = true, .flagged = true, .above_05 = true}, LoopOutcome{}}) {
    cell.methods.push_back(scores_of_outcomes(cell, LoopOutcomes(4, said), kScope));
    cell.methods.back().reason = text;
    cell.methods.back().reliability.add({0.1, 0.9, 0.0, 0.0, 0.0}, FaultSource::mpm);
  }
  Suite suite;
  suite.name = suite.version = suite.title = text;
  suite.plants = {{text, text}};
  suite.families = {{text, text}, {text + "2", text}};
  CellScores trouble{.family = 1, .trouble = text};
  Leaderboard board = make_leaderboard(suite, {text + "a", text + "b"}, text, {cell, trouble});
  board.own = {text + "a"};
  board.finished_by = text;
  return board;
}

TEST_CASE("hostile texts: pages, tables and files of a campaign take them as texts") {
  const char first = GENERATE('=', '+', '-', '@', '\t', '\r');
  const Campaign campaign = hostile_campaign(first);
  const StudyFindings findings = findings_of(campaign);
  for (const std::string& name : csv_table_names(campaign)) {
    CAPTURE(name);
    check_csv(csv_table(campaign, name));
  }
  if (first != '=')
    return;
  const std::string file = "<x0>" + hostile(first) + ".h5";
  check_html(report_html(campaign, findings, file, {}));
  const Campaign plain = made_up_campaign();  // what differs is told of studies as their texts say them
  Campaign other = plain;
  other.study.seed += 1;
  check_html(change_html(plain, file, other, file));
  for (const Document& document :
       {summary_document(campaign, findings, file), comparison_document(campaign, findings)}) {
    check_html(document_html(document));
    CHECK_NOTHROW(nlohmann::json::parse(document_json(document)));
  }
  check_latex(comparison_latex(campaign, findings));

  GateCheck check =
      check_gates(campaign, parse_gates("[[gate]]\naggregate = 'experiments'\nminimum = 1\nreason = 'r'\n",
                                        "g.toml", gate_findings(campaign.study)));
  check.name = check.title = hostile(first);
  check.baseline = BaselineComparison{
      hostile(first), hostile(first), {{hostile(first), hostile(first), ""}}, {hostile(first)}};
  const Document gates = gates_document(check, file);
  CHECK_NOTHROW(nlohmann::json::parse(document_json(gates)));
  CHECK_NOTHROW(nlohmann::json::parse(gates_badge(check)));
  check_markdown(document_markdown(gates));
  pugi::xml_document junit;
  REQUIRE(junit.load_string(gates_junit(check, file).c_str()));
  CHECK(junit.select_nodes("//x0").empty());
  CHECK(junit.select_nodes("//@onx0").empty());
  CHECK(junit.select_nodes("//testcase[starts-with(@name, 'answered.')]").size() > 10);
}

TEST_CASE("hostile texts: the board of a suite takes them as texts") {
  const char first = GENERATE('=', '+', '-', '@', '\t', '\r');
  const Leaderboard board = hostile_board(first);
  check_csv(leaderboard_csv(board));
  check_latex(leaderboard_latex(board));
  CHECK_NOTHROW(nlohmann::json::parse(leaderboard_json(board)));
  check_html(document_html(leaderboard_document(board)));
  pugi::xml_document figure;
  REQUIRE(figure.load_string(draw_figure(leaderboard_figure(board), FigureFormat::svg).c_str()));
  CHECK(figure.select_nodes("//x0").empty());
}

TEST_CASE("hostile texts: the table of a sweep takes them as texts") {
  const std::string text = hostile('=');
  Finding share{.name = "mpm.located", .label = as_label(text), .meaning = text, .form = FindingForm::share};
  share.prominence = Prominence::headline;
  const std::vector<SweepRow> rows{{"", "", true, "", {share}}, {text, text, true, text, {}}};
  const Document document = sweep_document(text, rows);
  check_markdown(document_markdown(document));
  CHECK_NOTHROW(nlohmann::json::parse(document_json(document)));
}

}  // namespace
