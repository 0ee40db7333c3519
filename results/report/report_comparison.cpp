#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_words.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/comparison_figures.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

using Methods = std::vector<MethodFindings>;

std::string introduction(const StudyFindings& findings) {
  return fmt::format(
      "<p>Every method has assessed the same {} of {} experiments, those that ran to their end, and has seen "
      "of each what a historian would have kept. Judge detection and false alarms together, for a method "
      "that flags every loop detects every fault; a rate that is missing had no loop to be counted on.</p>\n",
      findings.assessed, findings.experiments);
}

/// A value over its interval and what it rests on, both small.
std::string rate_cell(const Rate& rate) {
  return rate.total == 0 ? html_number(NAN)
                         : fmt::format("{}<br><small>{}<br>of {}</small>", html_number(rate.value, true),
                                       html_interval(rate.interval, true), rate.total);
}

std::string estimate_cell(const Estimate& estimate) {
  return estimate.count == 0 ? html_number(NAN)
                             : fmt::format("{}<br><small>{}<br>of {}</small>", html_number(estimate.value),
                                           html_interval(estimate.interval), estimate.count);
}

/// What the method states of its false alarms, and a mark when that is not what it does.
std::string stated_cell(const MethodFindings& method) {
  const MethodDescription& description = method.form->method();
  const FalseAlarmMark mark = false_alarm_mark(description, method.rates);
  const std::string stated = description.stated_false_alarms
                                 ? html_number(*description.stated_false_alarms, true)
                                 : std::string("none");
  return mark == FalseAlarmMark::none
             ? stated
             : fmt::format("{}<br><small><strong>! {} found</strong></small>", stated, to_string(mark));
}

/// One row a rate, one column a method: there are more rates than a page is wide.
std::string rates_table(const Study& study, const Methods& methods) {
  std::vector<HtmlTable::Column> columns{{"Share of loops", HtmlTable::Align::left}};
  for (const MethodFindings& method : methods)
    columns.push_back({html_text(method.name())});
  HtmlTable table(fmt::format("Shares of loops with their {}, and the number of loops looked at. "
                              "Rates that no loop was counted for are left out.",
                              interval_title(study)),
                  columns);
  for (const MethodRateInfo& info : counted_rates(methods)) {
    std::vector<std::string> cells{html_text(info.title)};
    for (const MethodFindings& method : methods)
      cells.push_back(rate_cell(method.rates.*info.rate));
    table.row(cells);
  }
  for (const MethodEstimateInfo& info : method_estimate_infos()) {
    const auto of = [&](const MethodFindings& method) -> const Estimate& {
      return method.rates.*info.estimate;
    };
    if (std::none_of(methods.begin(), methods.end(),
                     [&](const auto& method) { return of(method).count > 0; }))
      continue;
    std::vector<std::string> cells{html_text(info.title)};
    for (const MethodFindings& method : methods)
      cells.push_back(estimate_cell(of(method)));
    table.row(cells);
  }
  std::vector<std::string> stated{"false alarms, stated"};
  for (const MethodFindings& method : methods)
    stated.push_back(stated_cell(method));
  table.row(stated);
  return table.html();
}

/// What each rate counts.
std::string rates_legend(const Study& study) {
  std::string html = "<p><small>";
  for (const MethodRateInfo& info : method_rate_infos(study))
    html += fmt::format("<strong>{}</strong>: {}. ", html_text(info.title), html_text(info.meaning));
  for (const MethodEstimateInfo& info : method_estimate_infos(study))
    html += fmt::format("<strong>{}</strong>: {}. ", html_text(info.title), html_text(info.meaning));
  return fmt::format(
      "{}<strong>false alarms, stated</strong>: share of healthy loops that the method says it flags; marked "
      "when the interval of the share that it does flag does not hold it, or {:g} % where it states none. {}"
      "</small></p>\n",
      html, 100.0 * kUsualFalseAlarms, kOfOneBenchmark);
}

/// On what the thresholds were calibrated, and what they are.
std::string thresholds_table(const Campaign& campaign, const Methods& methods) {
  const CalibrationOptions& options = *campaign.study.calibration;
  std::vector<HtmlTable::Column> columns{{"Threshold", HtmlTable::Align::left}};
  for (const MethodFindings& method : methods)
    columns.push_back({html_text(method.name())});
  HtmlTable table(
      fmt::format("Thresholds on the score of each method, calibrated on {} healthy loops and {} with a "
                  "disturbance alone, of seed {}; missing where too few of them have a verdict.",
                  options.healthy, options.ud, campaign.calibration.seed),
      columns);
  for (const ThresholdInfo& info : threshold_infos()) {
    std::vector<std::string> cells{html_text(info.meaning)};
    for (const MethodFindings& method : methods)
      cells.push_back(html_number((method.rates.thresholds.*info.threshold).value.value_or(NAN)));
    table.row(cells);
  }
  return table.html();
}

void add_roc(ReportSection& section, const Methods& methods) {
  if (has_curves(methods, FlagTruth::fault))
    section.add(comparison_roc_figure(methods, FlagTruth::fault));
  else
    section.add(
        "<p class=\"absent\">ROC curves are left out: they need loops with a fault and healthy ones "
        "that a method has scored.</p>\n");
  if (has_curves(methods, FlagTruth::impact))
    section.add(comparison_roc_figure(methods, FlagTruth::impact));
}

std::string pairs_table(const StudyFindings& summary) {
  HtmlTable table(
      "Two methods on the loops that both gave a verdict on. Right is to flag the loops with a fault, "
      "or those with a fault that has an impact, and no others; p is that of McNemar&rsquo;s exact test, "
      "two-sided, and corrected by Holm for all pairs of a truth.",
      {{"First", HtmlTable::Align::left},
       {"Second", HtmlTable::Align::left},
       {"To be flagged", HtmlTable::Align::left},
       {"Loops"},
       {"First alone right"},
       {"Second alone right"},
       {"p"},
       {"p, corrected"}});
  for (const MethodPair& pair : summary.pairs)
    if (pair.loops > 0)
      table.row({html_text(summary.methods[pair.first].name()),
                 html_text(summary.methods[pair.second].name()), std::string(to_string(pair.truth)),
                 fmt::format("{}", pair.loops), fmt::format("{}", pair.test.lost),
                 fmt::format("{}", pair.test.gained), fmt::format("{:.2g}", pair.test.p_two_sided),
                 fmt::format("{:.2g}", pair.p_holm)});
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
  for (const MethodFindings& method : methods) {
    const MethodDescription& info = method.form->method();
    table.row({fmt::format("{}<br><small>{}</small>", html_text(info.name), html_text(info.title)),
               html_text(info.verdict), html_text(needs_text(info)), html_text(answers_text(info)),
               std::isnan(method.rates.milliseconds) ? html_number(NAN)
                                                     : fmt::format("{:.2f}", method.rates.milliseconds),
               reason_cell(method.rates)});
  }
  return table.html();
}

}  // namespace

ReportSection comparison_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  ReportSection section{"comparison", "Which method is right most often?", {}};
  const StudyFindings& summary = input.findings();
  if (summary.assessed == 0) {
    section.leave_out("it needs an experiment that ran to its end; there is none.");
    return section;
  }
  section.answer = comparison_answer(input);
  section.add(introduction(summary));
  Figure rates = comparison_rates_figure(campaign.study, summary.methods);
  if (!rates.panels.empty())
    section.add(std::move(rates));
  section.add(rates_table(campaign.study, summary.methods));
  section.add(rates_legend(campaign.study));
  if (campaign.study.calibration)
    section.add(thresholds_table(campaign, summary.methods));
  add_roc(section, summary.methods);
  const bool paired = std::any_of(summary.pairs.begin(), summary.pairs.end(),
                                  [](const MethodPair& pair) { return pair.loops > 0; });
  if (paired)
    section.add(pairs_table(summary));
  section.add(methods_table(summary.methods));
  return section;
}

}  // namespace mpm
