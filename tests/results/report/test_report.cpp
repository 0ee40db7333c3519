#include <algorithm>
#include <functional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "base/non_finite.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/document/document_html.hpp"
#include "results/files/archive_error.hpp"
#include "results/report/report.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

const Campaign& sample() {
  static const Campaign campaign = campaign_sample();
  return campaign;
}

/// What sections are made from; keeps the findings.
class Input {
 public:
  explicit Input(const Campaign& campaign, std::string file = "f")
      : findings_(findings_of(campaign)),
        parts_(summary_content(campaign, findings_)),
        input_{campaign, parts_, std::move(file), {}, listed_below(campaign)} {}

  operator const ReportInput&() const { return input_; }

 private:
  StudyFindings findings_;
  SummaryContent parts_;
  ReportInput input_;
};

std::string page_of(const Campaign& campaign, const std::string& file) {
  return report_html(campaign, findings_of(campaign), file, {});
}

std::vector<std::string> section_ids(const Campaign& campaign) {
  std::vector<std::string> ids;
  for (const Section& section : report_sections(Input(campaign)))
    ids.push_back(section.id);
  return ids;
}

/// Lets the chain of each experiment that has an answer say something else.
void change_chain(Campaign& campaign,
                  const std::function<void(const ExperimentRecord&, Diagnosis&)>& change) {
  for (ExperimentRecord& record : campaign.records) {
    Diagnosis chain = testing::diagnosis_of(record.chain());
    if (chain.ivar.size() == 0)
      continue;
    change(record, chain);
    set_chain(campaign.study, record, chain);
  }
}

std::string html_of(const Section& section) {
  Section drawn = section;
  std::erase_if(drawn.content, [](const auto& piece) { return std::holds_alternative<Figure>(piece); });
  const std::string page = document_html({.sections = {drawn}});
  return page.substr(page.find("<main>"), page.find("</main>") - page.find("<main>"));
}

bool has_figure(const Section& section) {
  return std::any_of(section.content.begin(), section.content.end(),
                     [](const auto& piece) { return std::holds_alternative<Figure>(piece); });
}

TEST_CASE("report: the page depends on the campaign and the name of the archive only") {
  const std::string page = page_of(sample(), "some/folder/out.h5");
  CHECK(page == page_of(sample(), "another/out.h5"));
  CHECK_THAT(page, Contains("mpmbench replay out.h5 ") && !Contains("some/folder"));
}

TEST_CASE("report: no page has a number that does not exist, however few experiments it is of") {
  const Campaign& all = sample();
  for (std::size_t count = 1; count <= all.records.size(); ++count) {
    Campaign few = all;
    few.records = {all.records.end() - static_cast<std::ptrdiff_t>(count), all.records.end()};
    remove_methods(few,
                   [](const std::string& name) { return name != "botelho"; });  // their numbers are made up
    const std::string page = page_of(few, "out.h5");
    std::smatch found;
    const bool has_nan =
        std::regex_search(page, found, std::regex("[^A-Za-z]nan[^A-Za-z]", std::regex::icase));
    CAPTURE(count, has_nan ? page.substr(std::max<std::ptrdiff_t>(found.position() - 200, 0), 250) : "");
    CHECK_FALSE(has_nan);
  }
}

TEST_CASE("report: of records that stay in the archive it is the same page with the same loops") {
  const TemporaryFolder folder;
  const Campaign campaign = GENERATE(0, 1) == 0 ? faultless_campaign() : drawn_campaign();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const Campaign read = read_archive(folder / "a.h5"), streamed = stream_archive(folder / "a.h5");
  REQUIRE(streamed.streamed);
  REQUIRE(streamed.records.empty());
  CHECK((page_of(streamed, "a.h5") == page_of(read, "a.h5")));
  const std::vector<ShownExperiment> shown = loops_to_show(streamed), expected = loops_to_show(read);
  REQUIRE(!expected.empty());
  REQUIRE(shown.size() == expected.size());
  const RecordBytes bytes(campaign.study, forms_of(campaign));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    CHECK(shown[i].reason == expected[i].reason);
    CHECK(bytes.differences(shown[i].record, expected[i].record) == std::vector<std::string>{});
  }
}

TEST_CASE("report: headline numbers are those of the summary, beside the reported ones") {
  const std::string html = html_of(rates_section(Input(sample(), "out.h5")));
  // 1 of the 7 experiments that did not fail is infeasible; Wilson's interval of 1/7 is 2.6 to 51.3 %.
  CHECK_THAT(
      html,
      Contains(
          "<td class=\"number\">14.3&nbsp;%<br><small>2.6 to 51.3&nbsp;%</small></td>"
          "<td class=\"number\">7</td><td class=\"number\">4.0&nbsp;%<br><small>of 400</small></td><td><span "
          "class=\"yes\">yes</span></td>"));
}

TEST_CASE("report: what another method than the chain shows stands under its name, and beside no headline") {
  const Campaign campaign = made_up_campaign();
  const Section section = rates_section(Input(campaign));
  const std::string html = html_of(section);
  CHECK_THAT(html, Contains(">MPM<") && Contains(">MPM, sse<") && Contains(">UD, badwe2009<"));
  REQUIRE(std::holds_alternative<Figure>(section.content.front()));
  const std::string script = std::get<Figure>(section.content.front()).panels.front().commands;
  CHECK_THAT(script, Contains("MPM: CV located") && !Contains("sse: CV located"));
}

TEST_CASE("report: a failed self-check cannot be overlooked") {
  Campaign unhealthy = sample();
  unhealthy.basis.healthy = false;
  CHECK_THAT(html_of(run_section(Input(unhealthy))), Contains("self-check FAILED"));
  CHECK_THAT(html_of(run_section(Input(sample()))), Contains("self-check passed"));
}

TEST_CASE("report: each wrong verdict stands there with its numbers and its command") {
  Campaign campaign = sample();
  constexpr std::int64_t kWrong = 5;
  Eigen::Index found = 0;
  change_chain(campaign, [&](const ExperimentRecord& record, Diagnosis& chain) {
    chain.impactful = record.draw.index == kWrong;
    if (!chain.impactful)
      return;
    chain.predicted_cv = found = (record.draw.true_cv() + 1) % 7;
    chain.indicator.i_mpm = 0.4321;
  });
  const std::string html = html_of(wrong_verdict_section(Input(campaign, "a b.h5")));
  CHECK_THAT(html, Contains("<code>mpmbench replay a b.h5 5</code>") && Contains("0.432") &&
                       Contains(fmt::format("<span class=\"no\">y{}</span>", found + 1)));
  CHECK_THAT(html, Contains("ended by signal 9") && Contains("mpmbench replay a b.h5 4"));
  CHECK_THAT(html, !Contains("mpmbench replay a b.h5 6"));
}

TEST_CASE("report: a section without data says in one sentence why it is left out") {
  const Campaign campaign = empty_campaign();
  int left_out = 0;
  for (const Section& section : report_sections(Input(campaign))) {
    INFO(section.id);
    CHECK_FALSE(section.content.empty());
    if (section.id == "run" || section.id == "basis")
      continue;
    CHECK_FALSE(has_figure(section));
    CHECK_THAT(html_of(section), Contains("Left out: ") && Contains("."));
    ++left_out;
  }
  CHECK(left_out == 15);
  CHECK_THAT(page_of(campaign, "f.h5"),
             Contains("Left out: this needs experiments of both kinds with impact; "
                      "there are 0 with an MPM and 0 with a UD."));
}

TEST_CASE("report: a study of named scenarios has their section in place of rates") {
  const Campaign campaign = scenario_campaign();
  CHECK(section_ids(campaign) == std::vector<std::string>{"run", "scenarios", "comparison", "sensitivity",
                                                          "interaction", "s0-perturbation", "basis",
                                                          "solver"});
  const Section section = scenarios_section(Input(campaign, "a b.h5"));
  CHECK(has_figure(section));
  const std::string html = html_of(section);
  CHECK_THAT(html, Contains("mpmbench replay a b.h5 4") && Contains("&lt;b&gt; &#39;all&#39; &amp; more"));
  CHECK_THAT(html, Contains("level (MPM), heat (MPM)") && Contains("infeasible") && Contains("died"));
  CHECK_THAT(html, Contains("gain of level/hot x 1.5") && Contains("time constant of level/drain x 2") &&
                       Contains("heat/hot is (2 s + 1) / (30 s^2 + 12 s + 1) e^(-4 s)"));
  CHECK_THAT(page_of(campaign, "f.h5"),
             Contains("figure-scenario-ivar") && !Contains("How often is the diagnosis right?"));

  Campaign none = campaign;
  none.records.clear();
  CHECK_THAT(html_of(scenarios_section(Input(none))), Contains("Left out: "));
}

TEST_CASE("report: several methods stand side by side, with curves where it can") {
  Campaign campaign = scenario_campaign();
  for (ExperimentRecord& record : campaign.records)
    if (record.status == ExperimentStatus::ok)
      record.assessments[1] = kept(record.assessments[1].form, Assessment::not_applicable("it needs <more>"));
  const Section section = comparison_section(Input(campaign));
  std::vector<std::string> figures;
  for (const auto& piece : section.content)
    if (const Figure* const figure = std::get_if<Figure>(&piece))
      figures.push_back(figure->name);
  CHECK(figures == std::vector<std::string>{"comparison-rates", "comparison-roc", "comparison-roc-impact"});
  const std::string html = html_of(section);
  CHECK_THAT(html, Contains("the same 3 of 5 experiments") && Contains("it needs &lt;more&gt;"));
  for (const RateRow& row : rows_for(campaign.study, rate_rows()))
    CHECK_THAT(html, Contains(std::string("<strong>") + row.heading + "</strong>: "));
  for (const std::string& method : method_names(campaign))
    CHECK_THAT(html, Contains(method));

  CHECK_THAT(html, !Contains("Thresholds from"));
  Campaign calibrated = campaign;
  calibrated.study.calibration.emplace();
  calibrated.calibration.seed = 4711;
  CHECK_THAT(html_of(comparison_section(Input(calibrated))),
             Contains("Thresholds from 200 healthy loops and 100 with a disturbance, seed 4711"));

  // Every loop of the sample has a fault, so that there is nothing to draw a curve with.
  CHECK_THAT(html_of(comparison_section(Input(sample()))), Contains("Left out: ROC curves"));
  remove_methods(campaign, [](const std::string& name) { return name != "botelho"; });
  CHECK_THAT(page_of(campaign, "f.h5"), !Contains("Which method is right most often?"));
}

TEST_CASE("report: a campaign without the chain has no section of it") {
  Campaign campaign =
      GENERATE(made_up_campaign(), faultless_campaign(), scenario_campaign(), empty_campaign());
  remove_methods(campaign, [](const std::string& name) { return name == "botelho"; });
  std::vector<std::string> ids{"run",         "rates",           "comparison", "sensitivity",
                               "interaction", "s0-perturbation", "basis",      "solver"};
  if (campaign.study.names_scenarios())
    ids.erase(ids.begin() + 1);
  CHECK(section_ids(campaign) == ids);
  const std::string page = page_of(campaign, "f.h5");
  CHECK_THAT(page, Contains("Which method is right most often?") && !Contains("I<sub>MPM</sub>") &&
                       !Contains("botelho"));
}

TEST_CASE("report: the verdict on top is of the CV where no method names a source") {
  Campaign campaign = made_up_campaign();
  remove_methods(campaign, [](const std::string& name) { return name != "sse"; });
  const auto flag = [&campaign](std::size_t loops) {
    for (ExperimentRecord& record : campaign.records)
      if (record.status == ExperimentStatus::ok) {
        record.assessments = {plain_verdict(campaign.methods.front().form, loops > 0, 1.0)};
        loops -= loops > 0 ? 1 : 0;
      }
  };
  // Right in all that it flags, of which there is one loop: that is no winner.
  flag(1);
  REQUIRE(findings_of(campaign).methods.front().rates["located"].total == 1);
  REQUIRE(findings_of(campaign).methods.front().rates["answered"].total > 2);
  CHECK_THAT(page_of(campaign, "f.h5"), Contains("no method both answers nearly always and detects") &&
                                            !Contains("<code>sse</code> flags"));
  flag(campaign.records.size());
  const StudyFindings findings = findings_of(campaign);
  const MethodRates& rates = findings.methods.front().rates;
  REQUIRE(rates["source"].total == 0);
  REQUIRE(rates["located"].total > 0);
  CHECK_THAT(page_of(campaign, "f.h5"),
             Contains("no method names a source; <code>sse</code> flags " + share_words(rates["detected"])) &&
                 Contains("in " + share_words(rates["located"]) + " of the loops it flags."));
}

TEST_CASE("an estimate in words: bounds say so, what is shorter is not longer by less, and rounding is 0") {
  CHECK(estimate_text(0.62, 0.55, 0.7, SizeBound::none) == "0.62 (0.55 to 0.7)");
  CHECK(estimate_text(0.101, 0.1, 0.103, SizeBound::at_most) == "at most 0.103");
  CHECK(estimate_text(8, 7.1, 8, SizeBound::at_least) == "at least 7.1");
  CHECK(estimate_text(2, kNaN, kNaN, SizeBound::none) == "2");
  CHECK(estimate_text(-7.97973e-19, -0.1, 0.1, SizeBound::none) == "0 (-0.1 to 0.1)");
  CHECK(dead_time_text(1.99, 1.9, 2.1, SizeBound::none, "s") == "longer by 1.99 (1.9 to 2.1) s");
  CHECK(dead_time_text(-0.434, -0.6, 0.1, SizeBound::none, "min") == "shorter by 0.434 (-0.1 to 0.6) min");
  CHECK(dead_time_text(-3, -3, -2, SizeBound::at_most, "s") == "shorter by at least 2 s");
  CHECK(dead_time_text(-1e-17, -1, 1, SizeBound::none, "s") == "longer by 0 (-1 to 1) s");
}

TEST_CASE("report: false alarms have a section and rows where model and plant agree in some experiments") {
  Campaign campaign = faultless_campaign();
  change_chain(campaign, [](const ExperimentRecord& record, Diagnosis& chain) {
    chain.impactful = is_faultless(record.draw.kind);
  });
  const Section section = false_alarm_section(Input(campaign));
  CHECK(has_figure(section));
  CHECK_THAT(html_of(section),
             Contains("healthy") && Contains("- setpoint weight") && Contains("100.0&nbsp;%") &&
                 Contains("S0 of an experiment with a bad tuning is that of the controller"));
  CHECK_THAT(html_of(rates_section(Input(campaign))),
             Contains("Model and plant agree") && Contains("false alarm, tuning slack weight"));
  CHECK_THAT(html_of(wrong_verdict_section(Input(campaign))), Contains("healthy") && Contains("tuning"));

  const auto has_section = [](const Campaign& of) {
    const std::vector<std::string> ids = section_ids(of);
    return std::find(ids.begin(), ids.end(), "false-alarms") != ids.end();
  };
  CHECK(has_section(campaign));
  CHECK_FALSE(has_section(made_up_campaign()));
}

TEST_CASE("report: awkward numbers and foreign texts make no broken page") {
  Campaign campaign = made_up_campaign();
  campaign.study.title = "<script>alert(1)</script> `id` '\"&";
  campaign.study.plant.cvs[0].name = "a_b <i> `x` 'y'";
  campaign.info.command = "run \xFF <b>";
  const std::string page = page_of(campaign, "<x>.h5");
  CHECK_THAT(page, !Contains("<script>alert") && !Contains("<i>") && !Contains("<b>") && !Contains("<x>"));
  CHECK_THAT(page, Contains("&lt;script&gt;alert(1)&lt;/script&gt; `id` &#39;&quot;&amp;"));
}

TEST_CASE("report: the same figures as files, and a folder that cannot be made") {
  const TemporaryFolder folder;
  const auto files = write_figures(sample(), findings_of(sample()), folder / "figures", FigureFormat::svg);
  CHECK(files.size() == 14);
  for (const auto& file : files)
    CHECK_THAT(file_content(file), Contains("<svg ") && Contains("</svg>"));
  make_file(folder / "file", "");
  CHECK_THROWS_AS(write_figures(sample(), findings_of(sample()), folder / "file", FigureFormat::svg),
                  ArchiveError);
  CHECK_THROWS_WITH(
      write_figures(sample(), findings_of(sample()), folder / "none/figures", FigureFormat::svg),
      Contains("none/figures: cannot make the folder"));
}

}  // namespace
