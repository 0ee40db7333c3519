#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/plot/plot_text.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/summary_content.hpp"
#include "results/summary/summary_data.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"

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

Section scenarios_section(const Campaign& campaign, const SummaryContent& parts, const std::string& file) {
  Section section{"scenarios", ""};
  if (!campaign.study.names_scenarios() || parts.findings.chain() == nullptr)
    return section;
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
  if (campaign.study.names_scenarios())
    return section;
  add_table(section, findings_table(campaign.study, parts.findings));
  add_table(section, dominance_table(campaign.study, parts.findings.dominance));
  if (!parts.s0_fits.empty())
    section.add(s0_change_table(campaign.study, parts));
  if (!parts.structure_fits.empty())
    section.add(s0_structure_table(campaign.study, parts));
  return section;
}

/// Adds a table of the first experiments, and how many there are in all.
void add_first(Section& section, const std::string& what, Table table, std::size_t count) {
  section.say(fmt::format("{} {}{}", counted(static_cast<std::int64_t>(count), "experiment"), what,
                          table.rows.empty() ? "" : ":"));
  add_table(section, std::move(table));
  if (count > kMostListed)
    section.say(fmt::format("and {} more", count - kMostListed));
}

Section experiments_section(const Campaign& campaign, const SummaryContent& parts, const std::string& file) {
  const Study& study = campaign.study;
  Section section{"experiments", ""};
  if (!parts.failures.empty())
    add_first(section, "failed", failed_table(study, parts, file, kMostListed), parts.failures.size());
  if (!study.names_scenarios() && parts.findings.chain() != nullptr)
    add_first(section, "with impact got a wrong verdict",
              wrong_table(study, parts, file, kMostListed,
                          [](std::int64_t index) { return fmt::to_string(index); }),
              parts.wrong_verdicts.size());
  return section;
}

}  // namespace

Document summary_document(const Campaign& campaign, const StudyFindings& findings, const std::string& file,
                          const std::optional<Unfinished>& unfinished) {
  const auto content = std::make_shared<const SummaryContent>(summary_content(campaign, findings));
  Document document;
  if (unfinished)
    document.lead = fmt::format(
        "PARTIAL: {} of {} experiments. The run is not finished, and its finished loops are not a random "
        "sample: slow loops come last. `replay` needs the archive.",
        unfinished->done, unfinished->experiments);
  document.sections = {run_section(campaign, *content), findings_section(campaign, *content),
                       scenarios_section(campaign, *content, file),
                       experiments_section(campaign, *content, file)};
  // The functions below keep the content alive as long as a writer may ask for the data.
  document.sections[0].data = [&campaign, content, unfinished](auto& json) {
    put_run(json, campaign, *content, unfinished);
  };
  document.sections[1].data = [&campaign, content](auto& json) {
    put_findings(json, campaign.study, *content);
  };
  document.sections[2].data = [&campaign](auto& json) { put_scenarios(json, campaign); };
  document.sections[3].data = [&campaign, content](auto& json) {
    put_experiments(json, campaign.info, *content);
  };
  if (findings.methods.size() > 1 || findings.chain() == nullptr) {
    document.sections.push_back({"compared", comparison_heading(campaign.study, findings)});
    document.sections.push_back(comparison_overview(campaign, findings));
    document.sections.push_back(comparison_section(campaign, findings));
  }
  return document;
}

}  // namespace mpm
