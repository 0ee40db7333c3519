#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "results/document/document_latex.hpp"
#include "results/plot/plot_text.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

/// Rates in the order of reading, each with the rate that replaces it if that one counts any loop. Rates that
/// count no loop are left out.
constexpr std::pair<std::string_view, std::string_view> kOverview[] = {
    {"false_alarm_healthy", ""},    {"detected_impact", "power_05_impact"},
    {"power_05_impact", ""},        {"located", ""},
    {"source", "source_05_impact"}, {"source_05_impact", ""},
};

bool is_counted(const StudyFindings& findings, std::string_view rate) {
  return !rate.empty() &&
         std::any_of(findings.methods.begin(), findings.methods.end(),
                     [rate](const MethodFindings& method) { return method.rates[rate].total > 0; });
}

/// Explains the mark of overview_cell().
std::string in_part_words() {
  return fmt::format("~: verdicts on fewer than {:g} % of the loops.", 100 * kFewestAnswers);
}

/// Methods are ranked by the first of these rates that counts any loop.
constexpr std::string_view kRankedBy[] = {"source_05_impact", "source", "power_05_impact", "detected_impact"};

std::vector<const MethodFindings*> by_rank(const StudyFindings& findings) {
  std::vector<const MethodFindings*> methods;
  for (const MethodFindings& method : findings.methods)
    methods.push_back(&method);
  for (const std::string_view rate : kRankedBy) {
    if (!is_counted(findings, rate))
      continue;
    const auto value = [rate](const MethodFindings* method) {
      return method->rates[rate].total > 0 ? method->rates[rate].value : -1.0;
    };
    std::stable_sort(methods.begin(), methods.end(),
                     [&value](const auto* one, const auto* other) { return value(one) > value(other); });
    break;
  }
  return methods;
}

/// "96 [90, 99]", with a mark if the method answers on too few of the loops.
Cell overview_cell(const MethodRates& rates, std::string_view name) {
  const Rate& rate = rates[name];
  Cell cell = number(rate, NumberForm::whole_percent);
  if (rates["answered"].value < kFewestAnswers && rate.total > 0)
    cell.mark = "~";
  return cell;
}

}  // namespace

std::vector<std::string> overview_rates(const StudyFindings& findings) {
  std::vector<std::string> names;
  for (const auto& [name, better] : kOverview)
    if (is_counted(findings, name) && !is_counted(findings, better))
      names.emplace_back(name);
  return names;
}

const MethodFindings* best_method(const StudyFindings& findings, std::string_view rate) {
  const MethodFindings* best = nullptr;
  for (const MethodFindings& method : findings.methods)
    if (method.rates[rate].total > 0 && answers_and_detects(method.rates) &&
        (best == nullptr || method.rates[rate].value > best->rates[rate].value))
      best = &method;
  return best;
}

bool was_judged(const StudyFindings& findings) {
  return std::any_of(findings.methods.begin(), findings.methods.end(), [](const MethodFindings& method) {
    return method.rates["located"].total > 0 || method.rates["source"].total > 0;
  });
}

std::string own_methods_words(const StudyFindings& findings) {
  std::string text;
  for (const MethodFindings* const method : by_rank(findings))
    if (!method->form->method().origin.empty() && method->rates["detected"].total > 0)
      text += fmt::format(" {} flags {} of the faults{}.", code(method->name()),
                          share_words(method->rates["detected"]),
                          method->rates["false_alarm_healthy"].total == 0
                              ? ""
                              : fmt::format(" and {} of the healthy loops",
                                            share_words(method->rates["false_alarm_healthy"])));
  return text;
}

std::string comparison_answer(const StudyFindings& findings) {
  std::string text;
  const auto best = [&](const char* what, std::string_view rate) {
    if (const MethodFindings* const method = best_method(findings, rate))
      text += fmt::format("{}{} by {}, {}", text.empty() ? "" : "; ", what, code(method->name()),
                          share_words(method->rates[rate]));
  };
  best("the CV is found most often", "located");
  best("the source", "source");
  best("the channel", "channel");
  const std::string own = own_methods_words(findings);
  if (text.empty())
    return was_judged(findings)
               ? "No method both answers nearly always and detects most faults, so none is called best." + own
               : "";
  text.front() = 'T';
  return text +
         (is_counted(findings, "false_alarm_healthy")
              ? ". The table shows the false alarms that each one costs."
              : ". No loop was healthy, so nothing is known of false alarms.") +
         own;
}

Table overview_table(const Campaign& campaign, const StudyFindings& findings) {
  const std::vector<std::string> columns = overview_rates(findings);
  Table table(
      fmt::format(
          "% of loops with {:g} % intervals. Impact: of the faults with an impact. CV located, and source "
          "of one fault: of the flagged loops.{}",
          100 * campaign.study.aggregate.confidence,
          is_counted(findings, "power_05_impact")
              ? " At 5 %: of the faults with an impact, at the threshold calibrated for 5 % false "
                "alarms."
              : ""),
      {{"Method", Table::Align::left}});
  for (const std::string& column : columns)
    table.columns.push_back({heading_of(column)});
  table.columns.push_back({kRunTime.heading});
  for (const MethodFindings* const method : by_rank(findings)) {
    if (method->rates["answered"].hits == 0)
      continue;
    std::vector<Cell> cells{as_label(method->name())};
    for (const std::string& column : columns)
      cells.push_back(overview_cell(method->rates, column));
    cells.emplace_back(Number{method->rates.milliseconds});
    table.row(std::move(cells));
  }
  return table;
}

std::string comparison_latex(const Campaign& campaign, const StudyFindings& findings) {
  const Table table = overview_table(campaign, findings);
  return table_latex(table, fmt::format("{}, seed {}, mpmbench {}. {}\n{}", as_label(campaign.study.name),
                                        campaign.study.seed, as_label(campaign.info.mpmbench_version),
                                        table.caption, in_part_words()));
}

Section comparison_overview(const Campaign& campaign, const StudyFindings& findings) {
  Section section{"comparison", "Which method is right most often?"};
  if (const std::string answer = comparison_answer(findings); !answer.empty())
    section.say(answer);
  if (Table table = overview_table(campaign, findings); !table.rows.empty())
    section.add(std::move(table));
  std::vector<std::string> silent;
  bool in_part = false;
  for (const MethodFindings& method : findings.methods) {
    const Rate& answered = method.rates["answered"];
    if (answered.hits == 0)
      silent.push_back(method.name());
    in_part = in_part || (answered.hits > 0 && answered.value < kFewestAnswers);
  }
  if (!silent.empty())
    section.say(fmt::format("No verdict on any loop: {}.", listed(silent)));
  if (in_part)
    section.say(in_part_words());
  return section;
}

}  // namespace mpm
