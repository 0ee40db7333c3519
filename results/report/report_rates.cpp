#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/chain_numbers.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kMeasured{colour::kBlue, Dash::solid, Mark::dot, 2.5, 0.8};
const Pen kReported{colour::kVermillion, Dash::none, Mark::hollow_diamond, 1.0, 1.3};

std::string agreement(const Finding& finding, double confidence) {
  const std::optional<bool> agrees = finding.agrees(confidence);
  if (!agrees)
    return "";
  return *agrees ? "<span class=\"yes\">yes</span>" : "<span class=\"no\">no</span>";
}

/// The reported value, and of how many experiments it is a share.
std::string reported_cell(const Finding& finding) {
  return html_number(finding.reported, finding.is_share()) +
         (finding.reported_of > 0 ? fmt::format("<br><small>of {}</small>", finding.reported_of) : "");
}

void add_row(HtmlTable& table, const Finding& finding, double confidence) {
  const bool share = finding.is_share();
  table.row({html_label(finding.label), html_number(finding.value, share),
             html_interval(finding.interval, share), reported_cell(finding), agreement(finding, confidence),
             fmt::format("{}", finding.count)});
}

/// "MPM"; of another method than the chain of the thesis "MPM, counterfactual".
std::string kind_heading(ExperimentKind kind, const std::string& method) {
  return method.empty() || method == kChainMethod ? kind_name(kind)
                                                  : fmt::format("{}, {}", kind_name(kind), method);
}

std::string rates_table(const ReportInput& input) {
  const std::vector<Finding>& rows = input.findings().rows;
  const bool any =
      std::any_of(rows.begin(), rows.end(), [](const Finding& finding) { return finding.has_reported(); });
  HtmlTable table(
      any ? "Measured values beside those that the study names as reported. They agree when both can "
            "be the same truth: a share with the sampling error of both, where the number of "
            "experiments behind the reported one is known; any other number when the "
            "interval holds the reported one."
          : "Measured values; the study names no reported ones.",
      {{"Quantity", HtmlTable::Align::left},
       {"Measured"},
       {interval_title(input.campaign.study)},
       {"Reported"},
       {"Agree", HtmlTable::Align::left},
       {"Count"}});
  const auto group =
      [&](
          const std::string& heading, FindingGroup of,
          const std::function<bool(const Finding&)>& belongs = [](const Finding&) { return true; }) {
        bool first = true;
        for (const Finding& finding : rows) {
          if (finding.group != of || finding.prominence == Prominence::detail || !belongs(finding))
            continue;
          if (first)
            table.group(heading);
          first = false;
          add_row(table, finding, input.campaign.study.aggregate.confidence);
        }
      };
  group("All experiments", FindingGroup::study);
  for (const MethodFindings& method : input.findings().methods)
    for (const KindFindings& kind : method.kinds)
      group(kind_heading(kind.kind, method.name()), FindingGroup::kind, [&](const Finding& finding) {
        // A method that answers no loop, for want of setpoints perhaps, has nothing to show.
        return finding.kind == kind.kind && finding.method == method.name() &&
               (method.name() == kChainMethod || method.rates.answered.hits > 0);
      });
  group("An error in S0", FindingGroup::s0);
  group("Model and plant agree", FindingGroup::faultless);
  return table.html();
}

/// The shares that a reader asks for first: where the chain of the thesis was asked those of no other method,
/// which are compared in a section of their own.
std::vector<const Finding*> headline(const ReportInput& input) {
  const bool of_chain = input.findings().chain() != nullptr;
  std::vector<const Finding*> chosen;
  for (const Finding& finding : input.findings().rows)
    if (finding.prominence == Prominence::headline && finding.is_share() &&
        (!of_chain || finding.method.empty() || finding.method == kChainMethod))
      chosen.push_back(&finding);
  return chosen;
}

std::string row_name(const Finding& finding) {
  return finding.kind && finding.group == FindingGroup::kind
             ? fmt::format("{}: {}", kind_heading(*finding.kind, finding.method), finding.label)
             : finding.label;
}

Figure headline_figure(const ReportInput& input) {
  const std::vector<const Finding*> values = headline(input);
  const auto rows = static_cast<double>(values.size());
  std::vector<Whisker> measured;
  std::vector<NamedPoint> reported;
  Axis y{.label = "", .lower = -0.6, .upper = rows - 0.4};
  y.words.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Finding& value = *values[i];
    const std::string name = row_name(value);
    const double at = rows - 1.0 - static_cast<double>(i);  // the first one on top
    const Interval& interval = value.interval;
    y.words[values.size() - 1 - i] = name;
    measured.push_back(
        {at, 100.0 * value.value, 100.0 * interval.lower, 100.0 * interval.upper,
         fmt::format("{}: {:.1f} %, interval {:.1f} to {:.1f} %, {} experiments", name, 100.0 * value.value,
                     100.0 * interval.lower, 100.0 * interval.upper, value.count)});
    if (value.has_reported())
      reported.push_back(
          {100.0 * value.reported, at, fmt::format("{}: reported {:.1f} %", name, 100.0 * value.reported)});
  }
  PanelScript panel("headline", "", {.label = "share of experiments (%)", .lower = -2, .upper = 102}, y);
  panel.points(reported, kReported);
  panel.level_whiskers(measured, kMeasured);
  Figure figure;
  figure.name = "headline-rates";
  figure.caption =
      "Headline rates with their intervals. \"Located\" and \"recognised\" are shares of the "
      "experiments with impact.";
  figure.legend = {
      {fmt::format("measured, {:g} % interval", 100.0 * input.campaign.study.aggregate.confidence),
       kMeasured}};
  if (!reported.empty())
    figure.legend.push_back({"reported", kReported});
  figure.panels = {
      panel.finish("Headline rates as points with intervals beside the reported values; the "
                   "table below has the numbers.",
                   70.0 + 30.0 * rows)};
  figure.columns = 1;
  return figure;
}

}  // namespace

ReportSection rates_section(const ReportInput& input) {
  ReportSection section{"rates", "How often is the diagnosis right?", {}};
  if (input.findings().experiments == 0) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  section.answer = rates_answer(input);
  section.add(headline_figure(input));
  section.add(rates_table(input));
  return section;
}

}  // namespace mpm
