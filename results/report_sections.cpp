#include "results/report_sections.hpp"

#include <fmt/format.h>

#include "results/plot_text.hpp"

namespace mpm {

void ReportSection::leave_out(const std::string& why) {
  add("<p class=\"absent\">Left out: " + html_text(why) + "</p>\n");
}

std::vector<ReportSection> report_sections(const ReportInput& input) {
  if (input.campaign.study.names_scenarios())
    return {run_section(input),         scenarios_section(input),
            sensitivity_section(input), s0_perturbation_section(input),
            basis_section(input),       solver_section(input)};
  std::vector<ReportSection> sections{run_section(input),          rates_section(input),
                                      variance_section(input),     location_section(input),
                                      indicator_section(input),    dominance_section(input),
                                      roc_section(input),          fault_size_section(input),
                                      sensitivity_section(input),  s0_perturbation_section(input),
                                      basis_section(input),        solver_section(input),
                                      wrong_verdict_section(input)};
  if (!input.parts.aggregate.false_alarms.empty())
    sections.insert(sections.begin() + 2, false_alarm_section(input));
  return sections;
}

std::string interval_title(const Study& study) {
  return fmt::format("{:g}&nbsp;% interval", 100.0 * study.aggregate.confidence);
}

}  // namespace mpm
