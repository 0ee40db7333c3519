#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "results/plot/plot_text.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

struct OverviewColumn {
  const char* title;
  Rate MethodRates::*rate;
  Rate MethodRates::*better = nullptr;  ///< takes its place where some loop counts for it
};

/// In the order of reading. Those that no loop counts for are left out.
constexpr OverviewColumn kOverviewColumns[] = {
    {"Healthy flagged", &MethodRates::false_alarm_healthy},
    {"Faults found", &MethodRates::detected_impact, &MethodRates::power_05_impact},
    {"Found at 5 %", &MethodRates::power_05_impact},
    {"CV located", &MethodRates::located},
    {"Source right", &MethodRates::source, &MethodRates::source_05_impact},
    {"Source at 5 %", &MethodRates::source_05_impact},
};

bool is_counted(const StudyFindings& findings, Rate MethodRates::*rate) {
  return rate != nullptr &&
         std::any_of(findings.methods.begin(), findings.methods.end(),
                     [rate](const MethodFindings& method) { return (method.rates.*rate).total > 0; });
}

/// "96 [90, 99]", with a mark for a method that answers on a part of the loops only.
Cell overview_cell(const MethodRates& rates, Rate MethodRates::*rate) {
  Cell cell = number(rates.*rate, NumberForm::whole_percent);
  if (rates.answered.value < kFewestAnswers && (rates.*rate).total > 0)
    cell.mark = "~";
  return cell;
}

}  // namespace

const MethodFindings* best_method(const StudyFindings& findings, Rate MethodRates::*rate) {
  const MethodFindings* best = nullptr;
  for (const MethodFindings& method : findings.methods)
    if ((method.rates.*rate).total > 0 && answers_and_detects(method.rates) &&
        (best == nullptr || (method.rates.*rate).value > (best->rates.*rate).value))
      best = &method;
  return best;
}

bool was_judged(const StudyFindings& findings) {
  return std::any_of(findings.methods.begin(), findings.methods.end(), [](const MethodFindings& method) {
    return method.rates.located.total > 0 || method.rates.source.total > 0;
  });
}

std::string comparison_answer(const StudyFindings& findings) {
  std::string text;
  const auto best = [&](const char* what, Rate MethodRates::*rate) {
    if (const MethodFindings* const method = best_method(findings, rate))
      text += fmt::format("{}{} by {}, {}", text.empty() ? "" : "; ", what, code(as_label(method->name())),
                          share_words(method->rates.*rate));
  };
  best("the CV is found most often", &MethodRates::located);
  best("the source", &MethodRates::source);
  best("the channel", &MethodRates::channel);
  if (text.empty())
    return was_judged(findings)
               ? "No method both answers nearly always and detects most faults, so none is called best."
               : "";
  text.front() = 'T';
  return text + (is_counted(findings, &MethodRates::false_alarm_healthy)
                     ? ". The table shows the false alarms that each one costs."
                     : ". No loop was healthy, so nothing is known of false alarms.");
}

Section comparison_overview(const Campaign& campaign, const StudyFindings& findings) {
  Section section{"comparison", "Which method is right most often?"};
  if (const std::string answer = comparison_answer(findings); !answer.empty())
    section.say(answer);
  std::vector<OverviewColumn> columns;
  for (const OverviewColumn& column : kOverviewColumns)
    if (is_counted(findings, column.rate) && !is_counted(findings, column.better))
      columns.push_back(column);
  Table table(
      fmt::format("% of loops with {:g} % intervals. Found: of the faults with an impact. CV "
                  "located and source right: of the flagged loops with a fault.{}",
                  100 * campaign.study.aggregate.confidence,
                  is_counted(findings, &MethodRates::power_05_impact)
                      ? " At 5 %: of the faults with an impact, at the threshold calibrated for 5 % false "
                        "alarms."
                      : ""),
      {{"Method", Table::Align::left}});
  for (const OverviewColumn& column : columns)
    table.columns.push_back({column.title});
  table.columns.push_back({"ms a loop"});
  bool in_part = false;
  std::vector<std::string> silent;
  for (const MethodFindings& method : findings.methods) {
    if (method.rates.answered.hits == 0) {
      silent.push_back(method.name());
      continue;
    }
    std::vector<Cell> cells{as_label(method.name())};
    for (const OverviewColumn& column : columns)
      cells.push_back(overview_cell(method.rates, column.rate));
    cells.emplace_back(Number{method.rates.milliseconds});
    table.row(std::move(cells));
    in_part = in_part || method.rates.answered.value < kFewestAnswers;
  }
  if (!table.rows.empty())
    section.add(std::move(table));
  if (!silent.empty())
    section.say(fmt::format("No verdict on any loop: {}.", listed(silent)));
  if (in_part)
    section.say(fmt::format("~: verdicts on fewer than {:g} % of the loops.", 100 * kFewestAnswers));
  return section;
}

}  // namespace mpm
