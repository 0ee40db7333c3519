#include "results/report/report_sections.hpp"

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"

namespace mpm {

void ReportSection::leave_out(const std::string& why) {
  add("<p class=\"absent\">Left out: " + html_text(why) + "</p>\n");
}

std::vector<ReportSection> report_sections(const ReportInput& input) {
  const bool named = input.campaign.study.names_scenarios();
  std::vector<ReportSection> sections =
      named ? std::vector{run_section(input), scenarios_section(input)}
            : std::vector{run_section(input),      rates_section(input),     variance_section(input),
                          location_section(input), indicator_section(input), dominance_section(input),
                          roc_section(input),      fault_size_section(input)};
  if (!input.parts.aggregate.false_alarms.empty())
    sections.insert(sections.begin() + 2, false_alarm_section(input));
  if (input.campaign.comparison)
    sections.push_back(comparison_section(input));
  for (const auto& section :
       {sensitivity_section, interaction_section, s0_perturbation_section, basis_section, solver_section})
    sections.push_back(section(input));
  if (!named)
    sections.push_back(wrong_verdict_section(input));
  return sections;
}

std::string interval_title(const Study& study) {
  return fmt::format("{:g}&nbsp;% interval", 100.0 * study.aggregate.confidence);
}

}  // namespace mpm
