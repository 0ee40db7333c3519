#include "results/plot/plot_text.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"

namespace mpm {
namespace {

void add_self_check(Section& section, const ReportInput& input) {
  const BasisCase& basis = input.campaign.basis;
  const std::string explanation = as_label(basis.explanation) + ".";
  if (basis.healthy)
    section.say(strong("Basis self-check passed.") + " " + explanation, Paragraph::Kind::passed);
  else
    section.say(strong("Basis self-check FAILED: no number below means anything.") + " " + explanation,
                Paragraph::Kind::failed);
  Table table("Ivar of the basis case, without mismatch and disturbance; a perfect model has 1.",
              {{"CV", Table::Align::left}});
  for (const PlantModel::Variable& cv : input.campaign.study.plant.cvs)
    table.columns.push_back({as_label(cv.name)});
  std::vector<Cell> cells{"Ivar"};
  for (const double ivar : basis.diagnosis.ivar)
    cells.emplace_back(Number{ivar, NumberForm::fixed});
  table.row(std::move(cells));
  section.add(std::move(table));
}

}  // namespace

Section run_section(const ReportInput& input) {
  Section section{"run", "What was run"};
  Facts facts = run_facts(input.campaign, input.parts);
  facts.add("command", code(input.campaign.info.command));
  section.add(std::move(facts));
  add_self_check(section, input);
  return section;
}

}  // namespace mpm
