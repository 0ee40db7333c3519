#include <fmt/format.h>

#include "results/document/document_text.hpp"
#include "results/plot/plot_text.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/summary_content.hpp"
#include "results/summary/summary_sections.hpp"

namespace mpm {
namespace {

void add_table(Section& section, Table table) {
  if (!table.rows.empty())
    section.add(std::move(table));
}

Section run_section(const Campaign& campaign, const SummaryContent& parts) {
  Section section{"run", ""};
  Facts facts = run_facts(campaign, parts);
  facts.add("self-check", fmt::format("{}: {}", campaign.basis.healthy ? "passed" : "FAILED",
                                      as_label(campaign.basis.explanation)));
  section.add(std::move(facts));
  return section;
}

Section scenarios_section(const Campaign& campaign, const std::string& file) {
  Section section{"scenarios", ""};
  for (Table table : {scenario_table(campaign, file), index_table(campaign), indicator_table(campaign)})
    add_table(section, std::move(table));
  if (Table acf = acf_table(campaign); acf.rows.empty())
    section.say("The autocorrelation functions of no CV differ from those of its nominal output.");
  else
    section.add(std::move(acf));
  return section;
}

Section findings_section(const Campaign& campaign, const SummaryContent& parts) {
  Section section{"findings", ""};
  add_table(section, findings_table(campaign.study, parts.findings));
  add_table(section, dominance_table(campaign.study, parts.findings.dominance));
  if (!parts.s0_fits.empty())
    section.add(s0_change_table(campaign.study, parts));
  if (!parts.structure_fits.empty())
    section.add(s0_structure_table(campaign.study, parts));
  return section;
}

/// A table of the first ones, and how many there are.
void add_first(Section& section, const std::string& what, Table table, std::size_t count) {
  section.say(
      fmt::format("{} experiment{} {}{}", count, count == 1 ? "" : "s", what, table.rows.empty() ? "" : ":"));
  add_table(section, std::move(table));
  if (count > kMostListed)
    section.say(fmt::format("and {} more", count - kMostListed));
}

}  // namespace

std::string summary_text(const Campaign& campaign, const StudyFindings& findings, const std::string& file,
                         const std::optional<Unfinished>& unfinished) {
  const SummaryContent parts = summary_content(campaign, findings);
  const Study& study = campaign.study;
  const bool chain = findings.chain() != nullptr;
  Document document;
  if (unfinished)
    document.lead = fmt::format(
        "PARTIAL: {} of {} experiments. The run is not finished, and what is done is no random sample: slow "
        "loops come "
        "last. `replay` needs the archive.",
        unfinished->done, unfinished->experiments);
  document.sections = {run_section(campaign, parts)};
  if (!study.names_scenarios())
    document.sections.push_back(findings_section(campaign, parts));
  else if (chain)
    document.sections.push_back(scenarios_section(campaign, file));
  Section& last = document.sections.emplace_back(Section{"experiments", ""});
  if (!parts.failures.empty())
    add_first(last, "failed", failed_table(study, parts, file, kMostListed), parts.failures.size());
  if (!study.names_scenarios() && chain)
    add_first(last, "with impact got a wrong verdict",
              wrong_table(study, parts, file, kMostListed,
                          [](std::int64_t index) { return fmt::to_string(index); }),
              parts.wrong_verdicts.size());
  const std::string text = document_text(document);
  return findings.methods.size() > 1 || !chain ? text + "\n" + comparison_text(campaign, findings) : text;
}

}  // namespace mpm
