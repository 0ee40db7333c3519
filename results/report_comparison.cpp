#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/assessment/method_rates.hpp"
#include "analysis/assessment/method_table.hpp"
#include "results/comparison_words.hpp"
#include "results/html_table.hpp"
#include "results/panel_script.hpp"
#include "results/plot_text.hpp"
#include "results/report_sections.hpp"

namespace mpm {
namespace {

/// Of the methods, in their order; neighbours differ in dash as well.
constexpr std::array<Pen, 7> kPens{{
    {colour::kBlue, Dash::solid, Mark::dot, 2.0, 0.8},
    {colour::kVermillion, Dash::dashed, Mark::square, 2.0, 0.8},
    {colour::kGreen, Dash::solid, Mark::triangle, 2.0, 0.9},
    {colour::kPurple, Dash::dashed, Mark::diamond, 2.0, 1.0},
    {colour::kOrange, Dash::solid, Mark::circle, 2.0, 0.8},
    {colour::kSky, Dash::dotted, Mark::hollow_diamond, 2.0, 1.0},
    {colour::kBlack, Dash::dashed, Mark::circle, 1.5, 0.8},
}};
const Pen kChance{colour::kGrey, Dash::dotted, Mark::none, 1.2};

using Methods = std::vector<MethodRates>;

/// A curve in the pen of its method.
Pen curve_pen(std::size_t method) {
  Pen pen = kPens[method % kPens.size()];
  pen.mark = Mark::none;
  return pen;
}

/// Whiskers in the colour of their method, solid so that short ones can be seen.
Pen whisker_pen(std::size_t method) {
  Pen pen = kPens[method % kPens.size()];
  pen.dash = Dash::solid;
  return pen;
}

std::string introduction(const Campaign& campaign) {
  return fmt::format(
      "<p>Every method has assessed the same {} of {} experiments, those that ran to their end, and has seen "
      "of each what a historian would have kept. Judge detection and false alarms together, for a method "
      "that flags every loop detects every fault; a rate that is missing had no loop to be counted on.</p>\n",
      campaign.comparison->loops.size(), campaign.records.size());
}

/// The rates that were counted on some loop of some method; the others are empty columns and panels.
std::vector<MethodRateInfo> counted_rates(const Methods& methods) {
  std::vector<MethodRateInfo> counted;
  for (const MethodRateInfo& info : method_rate_infos())
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const MethodRates& m) { return (m.*info.rate).total > 0; }))
      counted.push_back(info);
  return counted;
}

/// A value over its interval and what it rests on, both small.
std::string rate_cell(const Rate& rate) {
  return rate.total == 0 ? html_number(NAN)
                         : fmt::format("{}<br><small>{}<br>of {}</small>", html_number(rate.value, true),
                                       html_interval(rate.interval, true), rate.total);
}

/// One row a rate, one column a method: there are more rates than a page is wide.
std::string rates_table(const Study& study, const Methods& methods) {
  std::vector<HtmlTable::Column> columns{{"Share of loops", HtmlTable::Align::left}};
  for (const MethodRates& method : methods)
    columns.push_back({html_text(method.method)});
  HtmlTable table(fmt::format("Shares of loops with their {}, and the number of loops looked at. "
                              "Rates that no loop was counted for are left out.",
                              interval_title(study)),
                  columns);
  for (const MethodRateInfo& info : counted_rates(methods)) {
    std::vector<std::string> cells{html_text(info.title)};
    for (const MethodRates& method : methods)
      cells.push_back(rate_cell(method.*info.rate));
    table.row(cells);
  }
  return table.html();
}

/// What each rate counts.
std::string rates_legend() {
  std::string html = "<p><small>";
  for (const MethodRateInfo& info : method_rate_infos())
    html += fmt::format("<strong>{}</strong>: {}. ", html_text(info.title), html_text(info.meaning));
  return html + "</small></p>\n";
}

/// The places of the methods that gave some verdict; the others would be empty rows.
std::vector<std::size_t> answering(const Methods& methods) {
  std::vector<std::size_t> places;
  for (std::size_t m = 0; m < methods.size(); ++m)
    if (methods[m].answered.hits > 0)
      places.push_back(m);
  return places;
}

Whisker rate_whisker(const MethodRates& method, const Rate& rate, double at) {
  const double value = 100.0 * rate.value;
  const double lower = 100.0 * rate.interval.lower, upper = 100.0 * rate.interval.upper;
  return {at, value, lower, upper,
          fmt::format("{}: {:.1f} %, interval {:.1f} to {:.1f} %, {} of {} loops", method.method, value,
                      lower, upper, rate.hits, rate.total)};
}

Panel rate_panel(const MethodRateInfo& info, const Methods& methods) {
  const std::vector<std::size_t> places = answering(methods);
  const auto rows = static_cast<double>(places.size());
  Axis y{.label = "", .lower = -0.6, .upper = rows - 0.4};
  for (const std::size_t place : places)
    y.words.push_back(methods[place].method);
  std::reverse(y.words.begin(), y.words.end());  // the first one on top
  PanelScript panel(
      info.name, info.title,
      {.label = "share of loops (%)", .lower = -2, .upper = 102, .ticks = {0, 20, 40, 60, 80, 100}}, y);
  panel.left_margin(13);
  double at = rows;
  for (const std::size_t place : places) {
    const Rate& rate = methods[place].*info.rate;
    at -= 1.0;
    if (rate.total > 0)
      panel.level_whiskers({rate_whisker(methods[place], rate, at)}, whisker_pen(place));
  }
  return panel.finish(fmt::format("Share of loops with its interval, one row a method: {}.", info.meaning),
                      70.0 + 28.0 * rows);
}

/// A panel a rate; `answered` says nothing that the table does not.
Figure rates_figure(const Study& study, const Methods& methods) {
  Figure figure;
  figure.name = "comparison-rates";
  figure.caption = fmt::format(
      "How often each method that gave a verdict is right, with {:g} % intervals: false alarms and flags "
      "without impact are good on the left, all others on the right.",
      100.0 * study.aggregate.confidence);
  for (const MethodRateInfo& info : counted_rates(methods))
    if (info.rate != &MethodRates::answered)
      figure.panels.push_back(rate_panel(info, methods));
  return figure;
}

/// The curve with at most kMostPoints points, of which the first and the last are always there.
void draw_curve(PanelScript& panel, const RocCurve& roc, const Pen& pen) {
  std::vector<double> x, y;
  const std::size_t stride = roc.points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < roc.points.size(); ++i) {
    if (i % stride != 0 && i + 1 != roc.points.size())
      continue;
    x.push_back(100.0 * roc.points[i].false_positive_rate);
    y.push_back(100.0 * roc.points[i].true_positive_rate);
  }
  panel.line(x, y, pen);
}

/// Where the method itself draws the line: what it flags of both kinds of loops.
NamedPoint verdict_point(const MethodRates& method) {
  const double x = 100.0 * method.false_alarm_healthy.value, y = 100.0 * method.detected.value;
  return {x, y,
          fmt::format("{}: {:.1f} % of the faults detected, {:.1f} % false alarms", method.method, y, x)};
}

Figure roc_figure(const Methods& methods) {
  PanelScript panel(
      "comparison_roc", "",
      {.label = "healthy loops flagged (%)", .lower = 0, .upper = 100, .ticks = {0, 20, 40, 60, 80, 100}},
      {.label = "loops with a fault flagged (%)",
       .lower = 0,
       .upper = 101,
       .ticks = {0, 20, 40, 60, 80, 100}});
  panel.line({0, 100}, {0, 100}, kChance);
  Figure figure;
  figure.name = "comparison-roc";
  figure.caption =
      "Each method with any threshold on its score; the mark is its own verdict, which need not lie on the "
      "curve of a method that flags by more than one number.";
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (!methods[m].roc.defined())
      continue;
    draw_curve(panel, methods[m].roc, curve_pen(m));
    figure.legend.push_back(
        {fmt::format("{}, area {:.3f} ({:.3f} to {:.3f})", methods[m].method, methods[m].roc.area,
                     methods[m].roc_area.lower, methods[m].roc_area.upper),
         kPens[m % kPens.size()]});
  }
  for (std::size_t m = 0; m < methods.size(); ++m)
    if (methods[m].roc.defined())
      panel.points({verdict_point(methods[m])}, kPens[m % kPens.size()]);
  figure.legend.push_back({"chance", kChance});
  figure.panels = {
      panel.finish("Receiver operating characteristics of the scores of the methods, loops with a "
                   "fault against healthy ones.",
                   360)};
  return figure;
}

void add_roc(ReportSection& section, const Methods& methods) {
  if (std::any_of(methods.begin(), methods.end(), [](const MethodRates& m) { return m.roc.defined(); }))
    section.add(roc_figure(methods));
  else
    section.add(
        "<p class=\"absent\">ROC curves are left out: they need loops with a fault and healthy ones "
        "that a method has scored.</p>\n");
}

std::string pairs_table(const ComparisonSummary& summary) {
  HtmlTable table(
      "Two methods on the loops that both gave a verdict on. Right is to flag the loops with a fault, "
      "or those with a fault that has an impact, and no others; p is that of McNemar&rsquo;s exact test, "
      "two-sided.",
      {{"First", HtmlTable::Align::left},
       {"Second", HtmlTable::Align::left},
       {"To be flagged", HtmlTable::Align::left},
       {"Loops"},
       {"First alone right"},
       {"Second alone right"},
       {"p"}});
  for (const MethodPair& pair : summary.pairs)
    if (pair.loops > 0)
      table.row({html_text(summary.methods[pair.first].method),
                 html_text(summary.methods[pair.second].method), std::string(to_string(pair.truth)),
                 fmt::format("{}", pair.loops), fmt::format("{}", pair.test.lost),
                 fmt::format("{}", pair.test.gained), fmt::format("{:.2g}", pair.test.p_two_sided)});
  return table.html();
}

/// Why some loops have no verdict of the method.
std::string reason_cell(const MethodRates& method) {
  if (method.reason.empty())
    return "";
  return fmt::format("{} of {} loops: {}", method.answered.total - method.answered.hits,
                     method.answered.total, html_text(method.reason));
}

std::string methods_table(const Methods& methods) {
  HtmlTable table(
      "What a method needs of a loop and tells of it, its median processor time, and why it gave no "
      "verdict.",
      {{"Method", HtmlTable::Align::left},
       {"A flagged loop", HtmlTable::Align::text},
       {"Needs", HtmlTable::Align::left},
       {"Tells besides", HtmlTable::Align::left},
       {"ms a loop"},
       {"No verdict on", HtmlTable::Align::text}});
  for (const MethodRates& method : methods) {
    const AssessmentMethodInfo& info = assessment_method(method.method);
    table.row(
        {fmt::format("{}<br><small>{}</small>", html_text(info.name), html_text(info.title)),
         html_text(info.verdict), html_text(needs_text(info)), html_text(answers_text(info)),
         std::isnan(method.milliseconds) ? html_number(NAN) : fmt::format("{:.2f}", method.milliseconds),
         reason_cell(method)});
  }
  return table.html();
}

}  // namespace

ReportSection comparison_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  ReportSection section{"comparison", "Assessment methods compared", {}};
  const ComparisonSummary summary = summarise(*campaign.comparison, campaign.records, campaign.study);
  section.add(introduction(campaign));
  Figure rates = rates_figure(campaign.study, summary.methods);
  if (!rates.panels.empty())
    section.add(std::move(rates));
  section.add(rates_table(campaign.study, summary.methods));
  section.add(rates_legend());
  add_roc(section, summary.methods);
  const bool paired = std::any_of(summary.pairs.begin(), summary.pairs.end(),
                                  [](const MethodPair& pair) { return pair.loops > 0; });
  if (paired)
    section.add(pairs_table(summary));
  section.add(methods_table(summary.methods));
  return section;
}

}  // namespace mpm
