#include <fmt/format.h>

#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"

namespace mpm {
Section wrong_verdict_section(const ReportInput& input) {
  Section section{"wrong-verdicts", "Wrong verdicts", {}};
  if (!input.parts.failed.empty())
    section.add(failed_table(input.campaign.study, input.parts, input.file, kMostVerdictRows));
  if (input.parts.wrong.empty()) {
    section.leave_out("no experiment with impact got a wrong verdict.");
    return section;
  }
  std::int64_t impactful = 0;
  for (const KindFindings& kind : input.kinds())
    impactful += kind.flagged.hits;
  for (const FalseAlarms& group : input.false_alarms())
    impactful += group.parameter ? 0 : group.false_alarm.hits;
  section.say(
      fmt::format("{} of {} experiments with impact got a wrong verdict. {} plots the closed loop of one.",
                  input.parts.wrong_verdicts.size(), impactful,
                  code(fmt::format("mpmbench plot {} INDEX -o FILE.svg", input.file))));
  section.add(wrong_table(input.campaign.study, input.parts, input.file, kMostVerdictRows,
                          [&](std::int64_t index) { return input.number_words(index); }));
  if (input.parts.wrong_verdicts.size() > kMostVerdictRows)
    section.say(fmt::format("{} more; {} lists all.", input.parts.wrong_verdicts.size() - kMostVerdictRows,
                            code(fmt::format("mpmbench summary {} --json", input.file))));
  add_wrong_loops(section, input);
  return section;
}

}  // namespace mpm
