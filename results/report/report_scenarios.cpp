#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/report_sections.hpp"
#include "results/report/scenario_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
Section scenarios_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  Section section{"scenarios", "Named scenarios", {}};
  if (campaign.records.empty()) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  const Rate& right = input.findings().right_scenarios;
  section.say(fmt::format(
      "In {} feasible scenarios the flagged CVs are the affected ones, and every source is right.",
      strong(fmt::format("{} of {}", right.hits, right.total))));
  section.add(scenario_table(campaign, input.file));
  if (right.total > 0) {
    add_scenario_figures(section, campaign);
    section.add(index_table(campaign));
    section.add(indicator_table(campaign));
    add_distributions(section, campaign);
    add_autocorrelations(section, campaign);
  }
  Sentences failures;
  for (const ExperimentRecord* record : input.parts.failed)
    failures.words.push_back(
        as_label(scenario_name(campaign.study, *record) + ": failed: " + record->message));
  if (!failures.words.empty())
    section.add(std::move(failures));
  return section;
}

}  // namespace mpm
