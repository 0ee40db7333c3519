#include <algorithm>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "results/files/archive_error.hpp"
#include "results/report/report.hpp"
#include "results/report/report_sections.hpp"
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

std::string html_of(const ReportSection& section) {
  std::string html;
  for (const auto& piece : section.content)
    if (std::holds_alternative<Html>(piece))
      html += std::get<Html>(piece).text;
  return html;
}

bool has_figure(const ReportSection& section) {
  return std::any_of(section.content.begin(), section.content.end(),
                     [](const auto& piece) { return std::holds_alternative<Figure>(piece); });
}

TEST_CASE("report: the page depends on the campaign and the name of the archive only") {
  const std::string page = report_html(sample(), "some/folder/out.h5");
  CHECK(page == report_html(sample(), "another/out.h5"));
  CHECK_THAT(page, Contains("mpmbench replay out.h5 ") && !Contains("some/folder"));
}

TEST_CASE("report: headline numbers are those of the summary, beside the reported ones") {
  const SummaryParts parts = summary_parts(sample());
  const std::string html = html_of(rates_section({sample(), parts, "out.h5"}));
  // 1 of the 7 experiments that did not fail is infeasible; Wilson's interval of 1/7 is 2.6 to 51.3 %.
  CHECK_THAT(html,
             Contains("<td class=\"number\">14.3&nbsp;%</td><td class=\"number\">2.6 to 51.3&nbsp;%</td>"
                      "<td class=\"number\">4.0&nbsp;%</td><td><span class=\"yes\">yes</span></td>"));
}

TEST_CASE("report: a failed self-check cannot be overlooked") {
  Campaign unhealthy = sample();
  unhealthy.basis.healthy = false;
  const SummaryParts parts = summary_parts(unhealthy);
  CHECK_THAT(html_of(run_section({unhealthy, parts, "f"})), Contains("self-check FAILED"));
  CHECK_THAT(html_of(run_section({sample(), parts, "f"})), Contains("self-check passed"));
}

TEST_CASE("report: each wrong verdict stands there with its numbers and its command") {
  Campaign campaign = sample();
  for (ExperimentRecord& record : campaign.records)
    record.diagnosis.impactful = false;
  ExperimentRecord& wrong = campaign.records[5];
  wrong.diagnosis.impactful = true;
  wrong.diagnosis.predicted_cv = (wrong.draw.true_cv() + 1) % 7;
  wrong.diagnosis.indicator.i_mpm = 0.4321;
  const SummaryParts parts = summary_parts(campaign);
  const std::string html = html_of(wrong_verdict_section({campaign, parts, "a b.h5"}));
  CHECK_THAT(html,
             Contains("<code>mpmbench replay a b.h5 5</code>") && Contains("0.432") &&
                 Contains(fmt::format("<span class=\"no\">y{}</span>", wrong.diagnosis.predicted_cv + 1)));
  CHECK_THAT(html, Contains("ended by signal 9") && Contains("mpmbench replay a b.h5 4"));
  CHECK_THAT(html, !Contains("mpmbench replay a b.h5 6"));
}

TEST_CASE("report: a section without data says in one sentence why it is left out") {
  const Campaign campaign = empty_campaign();
  const SummaryParts parts = summary_parts(campaign);
  int left_out = 0;
  for (const ReportSection& section : report_sections({campaign, parts, "f"})) {
    INFO(section.id);
    CHECK_FALSE(section.content.empty());
    if (section.id == "run" || section.id == "basis")
      continue;
    CHECK_FALSE(has_figure(section));
    CHECK_THAT(html_of(section), Contains("Left out: ") && Contains("."));
    ++left_out;
  }
  CHECK(left_out == 12);
  CHECK_THAT(report_html(campaign, "f.h5"),
             Contains("Left out: it needs experiments with impact of both kinds; "
                      "there are 0 with an MPM and 0 with a UD."));
}

TEST_CASE("report: a study of named scenarios has their section in place of rates") {
  const Campaign campaign = scenario_campaign();
  const SummaryParts parts = summary_parts(campaign);
  std::vector<std::string> ids;
  for (const ReportSection& section : report_sections({campaign, parts, "f"}))
    ids.push_back(section.id);
  CHECK(ids == std::vector<std::string>{"run", "scenarios", "comparison", "sensitivity", "interaction",
                                        "s0-perturbation", "basis", "solver"});
  const ReportSection section = scenarios_section({campaign, parts, "a b.h5"});
  CHECK(has_figure(section));
  const std::string html = html_of(section);
  CHECK_THAT(html, Contains("mpmbench replay a b.h5 4") && Contains("&lt;b&gt; &#39;all&#39; &amp; more"));
  CHECK_THAT(html, Contains("level (MPM), heat (MPM)") && Contains("infeasible") && Contains("died"));
  CHECK_THAT(html, Contains("gain of level/hot x 1.5") && Contains("time constant of level/drain x 2") &&
                       Contains("heat/hot is (2 s + 1) / (30 s^2 + 12 s + 1) e^(-4 s)"));
  CHECK_THAT(report_html(campaign, "f.h5"), Contains("figure-scenario-ivar") && !Contains("Headline rates"));

  Campaign none = campaign;
  none.records.clear();
  const SummaryParts of_none = summary_parts(none);
  CHECK_THAT(html_of(scenarios_section({none, of_none, "f"})), Contains("Left out: "));
}

TEST_CASE("report: methods stand side by side when the archive has a comparison, with curves where it can") {
  Campaign campaign = scenario_campaign();
  campaign.comparison->reasons[0] = "it needs <more>";
  const SummaryParts parts = summary_parts(campaign);
  const ReportSection section = comparison_section({campaign, parts, "f"});
  std::vector<std::string> figures;
  for (const auto& piece : section.content)
    if (const Figure* const figure = std::get_if<Figure>(&piece))
      figures.push_back(figure->name);
  CHECK(figures == std::vector<std::string>{"comparison-rates", "comparison-roc"});
  const std::string html = html_of(section);
  CHECK_THAT(html, Contains("the same 3 of 5 experiments") && Contains("it needs &lt;more&gt;"));
  for (const MethodRateInfo& info : method_rate_infos())
    CHECK_THAT(html, Contains(std::string("<strong>") + info.title + "</strong>: "));
  for (const std::string& method : campaign.comparison->methods)
    CHECK_THAT(html, Contains(method));

  // Every loop of the sample has a fault, so that there is nothing to draw a curve with.
  const SummaryParts of_sample = summary_parts(sample());
  CHECK_THAT(html_of(comparison_section({sample(), of_sample, "f"})), Contains("ROC curves are left out"));
  campaign.comparison.reset();
  CHECK_THAT(report_html(campaign, "f.h5"), !Contains("Assessment methods compared"));
}

TEST_CASE("report: false alarms have a section and rows where model and plant agree in some experiments") {
  Campaign campaign = faultless_campaign();
  for (ExperimentRecord& record : campaign.records)
    record.diagnosis.impactful = is_faultless(record.draw.kind);
  const SummaryParts parts = summary_parts(campaign);
  const ReportSection section = false_alarm_section({campaign, parts, "f"});
  CHECK(has_figure(section));
  CHECK_THAT(html_of(section),
             Contains("healthy") && Contains("&emsp;setpoint weight") && Contains("100.0&nbsp;%") &&
                 Contains("S0 of an experiment with a bad tuning is that of the controller"));
  CHECK_THAT(html_of(rates_section({campaign, parts, "f"})),
             Contains("Model and plant agree") && Contains("false alarm, tuning slack weight"));
  CHECK_THAT(html_of(wrong_verdict_section({campaign, parts, "f"})),
             Contains("healthy") && Contains("tuning"));

  const auto has_section = [](const Campaign& of) {
    const SummaryParts of_parts = summary_parts(of);
    const auto sections = report_sections({of, of_parts, "f"});
    return std::any_of(sections.begin(), sections.end(),
                       [](const ReportSection& found) { return found.id == "false-alarms"; });
  };
  CHECK(has_section(campaign));
  CHECK_FALSE(has_section(made_up_campaign()));
}

TEST_CASE("report: awkward numbers and foreign texts make no broken page") {
  Campaign campaign = made_up_campaign();
  campaign.study.title = "<script>alert(1)</script> `id` '\"&";
  campaign.study.plant.cvs[0].name = "a_b <i> `x` 'y'";
  campaign.info.command = "run \xFF <b>";
  const std::string page = report_html(campaign, "<x>.h5");
  CHECK_THAT(page, !Contains("<script") && !Contains("<i>") && !Contains("<b>") && !Contains("<x>"));
  CHECK_THAT(page, Contains("&lt;script&gt;alert(1)&lt;/script&gt; `id` &#39;&quot;&amp;"));
}

TEST_CASE("report: the same figures as files, and a folder that cannot be made") {
  const TemporaryFolder folder;
  const auto files = write_figures(sample(), folder / "figures", FigureFormat::svg);
  CHECK(files.size() == 13);
  for (const auto& file : files)
    CHECK_THAT(file_content(file), Contains("<svg ") && Contains("</svg>"));
  make_file(folder / "file", "");
  CHECK_THROWS_AS(write_figures(sample(), folder / "file", FigureFormat::svg), ArchiveError);
  CHECK_THROWS_WITH(write_figures(sample(), folder / "none/figures", FigureFormat::svg),
                    Contains("none/figures: cannot make the folder"));
}

}  // namespace
