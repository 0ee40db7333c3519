#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/chain_numbers.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_sections.hpp"
#include "results/report/scenario_sections.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

/// The flagged CVs, each with its I_MPM and the source.
std::string flagged_cell(const Study& study, const Diagnosis& diagnosis) {
  std::string html;
  for (std::size_t i = 0; i < diagnosis.cvs.size(); ++i)
    if (const CvDiagnosis& cv = diagnosis.cvs[i]; cv.flagged)
      html += fmt::format("{}{}: {} ({})", html.empty() ? "" : "<br>", html_text(study.plant.cvs[i].name),
                          html_number(cv.distribution.mpm.i_mpm), source_name(cv.source));
  return html.empty() ? "none" : html;
}

std::string verdict_cell(const Study& study, const ExperimentRecord& record) {
  const std::string text = html_text(scenario_verdict_text(study, record));
  const AssessmentRecord& chain = *record.by(kChainMethod);
  return !chain.answered() ? text
                           : fmt::format("<span class=\"{}\">{}</span>",
                                         judge(study, record, chain).wrong() ? "no" : "yes", text);
}

std::string scenario_table(const ReportInput& input) {
  const Study& study = input.campaign.study;
  HtmlTable table(
      "Scenarios, and the verdict on each CV against what the study says. Flagged: Ivar<sub>diag</sub> "
      "outside the band of impact, with I<sub>MPM</sub> and the source it points at.",
      {{"Scenario", HtmlTable::Align::left},
       {"What is wrong, and how to replay it", HtmlTable::Align::text},
       {"Affected", HtmlTable::Align::left},
       {"Flagged: I<sub>MPM</sub>", HtmlTable::Align::left},
       {"TSSE"},
       {"Verdict", HtmlTable::Align::left}});
  for (const ExperimentRecord& record : input.campaign.records) {
    const Scenario& scenario = study.scenarios[static_cast<std::size_t>(record.draw.index)];
    const Diagnosis chain = record.chain();
    table.row(
        {html_text(scenario.name),
         fmt::format("{}{}<br><code>mpmbench replay {} {}</code>",
                     scenario.description.empty()
                         ? ""
                         : "<strong>" + html_text(scenario.description) + "</strong><br>",
                     html_text(fault_text(study, record.draw)), html_text(input.file), record.draw.index),
         html_text(affected_text(study, record.draw)), flagged_cell(study, chain),
         html_number(total_simulation_error(chain)), verdict_cell(study, record)});
  }
  return table.html();
}

/// Ivar and Ivar_diag of every CV; what lies outside the band of impact is marked.
std::string index_table(const Campaign& campaign) {
  const Study& study = campaign.study;
  std::vector<HtmlTable::Column> columns{{"Scenario", HtmlTable::Align::left},
                                         {"Index", HtmlTable::Align::left}};
  for (const PlantModel::Variable& cv : study.plant.cvs)
    columns.push_back({html_text(cv.name)});
  HtmlTable table("Ivar and Ivar<sub>diag</sub> of every CV; marked: outside the band of impact.", columns);
  const auto row = [&](const std::string& name, const char* index, const Eigen::VectorXd& values) {
    std::vector<std::string> cells{name, index};
    for (const double value : values)
      cells.push_back(study.diagnosis.has_impact(value)
                          ? "<span class=\"no\">" + html_number(value) + "</span>"
                          : html_number(value));
    table.row(cells);
  };
  for (const ExperimentRecord& record : campaign.records) {
    const Diagnosis chain = record.chain();
    row(html_text(scenario_name(study, record)), "Ivar", chain.ivar);
    row("", "Ivar<sub>diag</sub>", chain.ivar_diag);
  }
  return table.html();
}

std::string failures(const ReportInput& input) {
  std::string html;
  for (const ExperimentRecord* record : input.parts.failed)
    html += fmt::format("<li>{}: {}</li>\n", html_text(scenario_name(input.campaign.study, *record)),
                        html_text(record->message));
  return html.empty() ? html : "<p>Failed:</p>\n<ul>\n" + html + "</ul>\n";
}

}  // namespace

ReportSection scenarios_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  ReportSection section{"scenarios", "Named scenarios", {}};
  if (campaign.records.empty()) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  std::int64_t right = 0, judged = 0;
  for (const ExperimentRecord& record : campaign.records) {
    const AssessmentRecord& chain = *record.by(kChainMethod);
    judged += chain.answered() ? 1 : 0;
    right += chain.answered() && !judge(campaign.study, record, chain).wrong() ? 1 : 0;
  }
  section.add(
      fmt::format("<p>In <strong>{} of {}</strong> feasible scenarios the flagged CVs are the affected "
                  "ones, and the source of each is right.</p>\n",
                  right, judged));
  section.add(scenario_table(input));
  if (judged > 0) {
    add_scenario_figures(section, campaign);
    section.add(index_table(campaign));
    add_distributions(section, campaign);
    add_autocorrelations(section, campaign);
  }
  section.add(failures(input));
  return section;
}

}  // namespace mpm
