#include <fmt/format.h>

#include "results/archive/variable_text.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::string fact(const char* name, const std::string& html) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, html);
}

std::string variables(const std::vector<PlantModel::Variable>& list, const char* kind) {
  return fmt::format("{} {}{}", list.size(), kind, list.size() == 1 ? "" : "s");
}

std::string plant_text(const PlantModel& plant) {
  return fmt::format("{}<br><small>{}: {}, {}, {}</small>", html_text(plant.title), html_text(plant.name),
                     variables(plant.cvs, "CV"), variables(plant.mvs, "MV"), variables(plant.mds, "MD"));
}

/// What the controller holds its CVs to.
std::string controller_name(const Study& study) {
  if (study.controller_program)
    return fmt::format("program <code>{}</code>",
                       html_text(fmt::format("{}", fmt::join(study.controller_program->command(), " "))));
  const MpcOptions& controller = study.controller;
  const std::string holds =
      controller.has_setpoints()
          ? controller.has_soft_limits() ? "MPC with setpoints and ranges" : "setpoint MPC"
          : "range MPC";
  return holds + (controller.has_targets() ? " with target optimizer" : "");
}

std::string controller_text(const Study& study) {
  return fmt::format("{}<br><small>sample time {:g} {}, prediction horizon {}, control horizon {}</small>",
                     controller_name(study), study.controller.sample_time,
                     html_text(unit_text(study.plant.time_unit)), study.controller.prediction_horizon,
                     study.controller.control_horizon);
}

std::string experiments_text(const ReportInput& input) {
  const StudyFindings& total = input.findings();
  return fmt::format("{}, each a loop of {} samples<br><small>{}; {}</small>", total.experiments,
                     input.campaign.study.simulation.samples,
                     kinds_text(input.campaign.study, input.parts.kinds),
                     endings_text(input.campaign.study, total));
}

std::string program_text(const CampaignInfo& info) {
  return fmt::format("mpmbench {}<br><small>revision {}</small>", html_text(info.mpmbench_version),
                     html_text(info.git_sha.empty() ? "unknown" : info.git_sha));
}

std::string self_check(const ReportInput& input) {
  const BasisCase& basis = input.campaign.basis;
  const Study& study = input.campaign.study;
  std::string explanation = html_text(basis.explanation);
  std::string html =
      basis.healthy
          ? "<p class=\"check passed\"><strong>Basis self-check passed.</strong> " + explanation + ".</p>\n"
          : "<p class=\"check failed\"><strong>Basis self-check FAILED: no number below means "
            "anything.</strong> " +
                explanation + ".</p>\n";
  HtmlTable table("Ivar of the basis case, without mismatch and disturbance; a perfect model has 1.", [&] {
    std::vector<HtmlTable::Column> columns{{"CV", HtmlTable::Align::left}};
    for (const PlantModel::Variable& cv : study.plant.cvs)
      columns.push_back({html_text(cv.name)});
    return columns;
  }());
  std::vector<std::string> cells{"Ivar"};
  for (const double ivar : basis.diagnosis.ivar)
    cells.push_back(html_number(ivar));
  table.row(cells);
  return html + table.html();
}

}  // namespace

ReportSection run_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const CampaignInfo& info = input.campaign.info;
  ReportSection section{"run", "What was run", {}};
  section.add("<dl class=\"facts\">\n" + fact("Plant", plant_text(study.plant)) +
              fact("Controller", controller_text(study)) + fact("Experiments", experiments_text(input)) +
              fact("Seed", fmt::format("{}", study.seed)) + fact("Program", program_text(info)) +
              fact("Solver", html_text(info.solver)) +
              fact("Finished", fmt::format("{}<br><small>after {:.1f} s, {} at once</small>",
                                           html_text(info.created), info.seconds, info.jobs)) +
              fact("Command", "<code>" + html_text(info.command) + "</code>") + "</dl>\n");
  section.add(self_check(input));
  return section;
}

}  // namespace mpm
