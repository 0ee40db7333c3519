#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_words.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/comparison_figures.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

using Methods = std::vector<MethodFindings>;

/// Explains what each rate counts.
std::string rates_legend(const Study& study) {
  std::string words;
  for (const MethodNumber& number : method_numbers())
    if (has_feature(study, number.of))
      words += fmt::format("{}: {}. ", strong(number.heading), as_label(number.meaning));
  return words + strong(kStatedAlarmsHeading) + ": share of healthy loops that the method claims to flag.";
}

Table methods_table(const Methods& methods) {
  Table table("What each method needs from a loop and says about it.",
              {{"Method", Table::Align::left},
               {"A flagged loop", Table::Align::text},
               {"Needs", Table::Align::left},
               {"Tells besides", Table::Align::left}});
  for (const MethodFindings& method : methods) {
    const MethodDescription& info = method.form->method();
    table.row({Cell(as_label(info.name)).with(as_label(info.title)), as_label(info.verdict),
               as_label(needs_text(info)), as_label(answers_text(info))});
  }
  return table;
}

}  // namespace

Section comparison_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  Section section{"comparison", "Which method is right most often?", {}};
  const StudyFindings& summary = input.findings();
  if (summary.assessed == 0) {
    section.leave_out("no experiment ran to its end.");
    return section;
  }
  section.answer = comparison_answer(summary);
  section.say(fmt::format(
      "Every method has assessed the same {} of {} experiments, those that ran to their end, and saw of each "
      "only what a historian would have kept. Judge detection and false alarms together: a method that flags "
      "every loop detects every fault. A rate is missing if no loop counts for it.",
      summary.assessed, summary.experiments));
  Figure rates = comparison_rates_figure(campaign.study, summary.methods);
  if (!rates.panels.empty())
    section.add(std::move(rates));
  if (has_curves(summary.methods, FlagTruth::fault))
    section.add(comparison_roc_figure(summary.methods, FlagTruth::fault));
  else
    section.leave_out("ROC curves need loops with a fault and healthy loops that a method has scored.");
  if (has_curves(summary.methods, FlagTruth::impact))
    section.add(comparison_roc_figure(summary.methods, FlagTruth::impact));
  for (auto& piece : comparison_section(campaign, summary).content)
    section.content.push_back(std::move(piece));
  section.say(rates_legend(campaign.study), Paragraph::Kind::small);
  section.add(methods_table(summary.methods));
  return section;
}

}  // namespace mpm
