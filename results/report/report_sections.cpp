#include "results/report/report_sections.hpp"

namespace mpm {

const std::vector<KindFindings>& ReportInput::kinds() const {
  static const std::vector<KindFindings> none;
  return findings().chain() == nullptr ? none : findings().chain()->kinds;
}

const std::vector<FalseAlarms>& ReportInput::false_alarms() const {
  static const std::vector<FalseAlarms> none;
  return findings().chain() == nullptr ? none : findings().chain()->false_alarms;
}

std::vector<Section> report_sections(const ReportInput& input) {
  const bool named = input.campaign.study.names_scenarios();
  const bool chain = input.findings().chain() != nullptr;
  std::vector<Section> sections{run_section(input)};
  const auto add = [&](std::initializer_list<Section (*)(const ReportInput&)> list) {
    for (const auto& section : list)
      sections.push_back(section(input));
  };
  if (!named)
    add({rates_section});
  if (chain && !named)
    add({loops_section});
  if (!input.false_alarms().empty())
    add({false_alarm_section});
  if (chain && named)
    add({scenarios_section});
  if (chain && !named)
    add({variance_section, location_section, indicator_section, dominance_section, roc_section,
         fault_size_section});
  if (input.campaign.methods.size() > 1 || !chain)
    add({comparison_section});
  add({sensitivity_section, interaction_section, s0_perturbation_section, basis_section, solver_section});
  if (chain && !named)
    add({wrong_verdict_section, experiments_section});
  return sections;
}

}  // namespace mpm
