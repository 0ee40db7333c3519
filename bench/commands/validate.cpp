#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/validation/study_forecast.hpp"
#include "analysis/validation/study_warnings.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/study_pilot.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/execution/run_options.hpp"
#include "results/text/number_json.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kPilot = 20;

struct ValidateArguments {
  std::string study;
  RunOptions run;
  bool json = false;
  bool quiet = false;
};

/// What validate has found out about a study.
struct Validation {
  StudyPilot pilot;
  std::vector<StudyWarning> warnings;
  ModelAssumption assumption;
};

void append(std::vector<StudyWarning> more, std::vector<StudyWarning>& warnings) {
  std::move(more.begin(), more.end(), std::back_inserter(warnings));
}

/// Runs the basis case and, if that runs to its end, a pilot of the study.
Validation validated(const ValidateArguments& arguments, Progress& progress) {
  const Study study = find_study(arguments.study);
  Validation found;
  found.warnings = study_warnings(study);
  RunOptions options = arguments.run;
  const std::int64_t loops =
      std::min<std::int64_t>(options.experiments.value_or(kPilot), study.experiment_count());
  options.experiments.reset();
  try {
    found.pilot = run_pilot(study, options, loops, hooks_of(progress));
  } catch (const UnhealthyBasis&) {  // the basis case does not run to its end: the warnings may say why
    for (const StudyWarning& warning : found.warnings)
      progress.warn(to_string(warning));
    throw;
  }
  const Campaign& campaign = found.pilot.campaign;
  append(basis_warnings(campaign.study, campaign.basis), found.warnings);
  found.assumption = model_assumption(
      assessment_context(campaign.study, campaign.basis, qp_solver_factory(campaign.info.solver)));
  append(forecast_warnings(campaign.study, found.pilot.forecast, campaign.records), found.warnings);
  return found;
}

double megabytes(const StudyForecast& forecast, double share) {
  return 1e-6 * share * static_cast<double>(forecast.experiments) *
         static_cast<double>(forecast.bytes_of_a_loop);
}

std::string validation_json(const Validation& found, int jobs) {
  const StudyForecast& forecast = found.pilot.forecast;
  Json json{
      {"study", found.pilot.campaign.study.name},
      {"warnings", Json::array()},
      {"basis",
       {{"healthy", found.pilot.campaign.basis.healthy},
        {"explanation", found.pilot.campaign.basis.explanation}}},
      {"assessment_model", {{"model", to_string(found.assumption.model)}, {"why", found.assumption.why}}},
      {"experiments", forecast.experiments},
      {"pilot", found.pilot.campaign.records.size()},
      {"feasible", rate_json(forecast.feasible)},
      {"impact", rate_json(forecast.impact)},
      {"loops_with_impact", forecast.loops_with_impact},
      {"loops_without_fault", forecast.loops_without_fault},
      {"detection_width", forecast.detection_width},
      {"false_alarm_width", forecast.false_alarm_width},
      {"milliseconds_of_a_loop", found.pilot.milliseconds_of_a_loop},
      {"methods", Json::array()},
      {"jobs", jobs},
      {"seconds", found.pilot.seconds},
      {"megabytes",
       {{"flagged", megabytes(forecast, forecast.to_keep.value)}, {"all", megabytes(forecast, 1.0)}}}};
  if (forecast.worlds > 0) {
    json["worlds"] = forecast.worlds;
    json["detection_width_limit"] = forecast.detection_width_limit;
    json["false_alarm_width_limit"] = forecast.false_alarm_width_limit;
  }
  for (const StudyWarning& warning : found.warnings)
    json["warnings"].push_back({{"key", warning.key}, {"found", warning.found}, {"advice", warning.advice}});
  for (const StudyForecast::MethodCost& method : forecast.methods)
    json["methods"].push_back({{"name", method.method}, {"milliseconds", method.milliseconds}});
  return json_text(json);
}

/// How exactly the number of worlds lets rates be known.
std::string worlds_text(const StudyForecast& forecast) {
  std::string limits;
  if (forecast.loops_with_impact > 0)
    limits += fmt::format(", the first to +- {:.3f}", forecast.detection_width_limit / 2.0);
  if (forecast.loops_without_fault > 0)
    limits += fmt::format(", that of false alarms to +- {:.3f}", forecast.false_alarm_width_limit / 2.0);
  return fmt::format(
      "worlds: {}; more experiments in the same worlds narrow these intervals at best{}; more worlds "
      "(world.count) narrow them further\n",
      forecast.worlds, limits.empty() ? " to where they are" : limits);
}

std::string text_of(const Validation& found, int jobs) {
  const StudyForecast& forecast = found.pilot.forecast;
  const Study& study = found.pilot.campaign.study;
  std::string text = fmt::format("{}: {}\n", study.name, study.title);
  for (const StudyWarning& warning : found.warnings)
    text += fmt::format("warning: {}\n", to_string(warning));
  if (found.warnings.empty())
    text += "no warnings\n";
  text += fmt::format("basis case: {}\n", found.pilot.campaign.basis.explanation);
  text += to_string(found.assumption) + "\n";
  text += fmt::format("pilot: {} of {} experiments, {} feasible\n", found.pilot.campaign.records.size(),
                      forecast.experiments, forecast.feasible.hits);
  if (forecast.impact.total > 0)
    text += fmt::format(
        "impact: {} of {} faults; about {:.0f} loops with impact in the study [{:.0f}, {:.0f}], over which a "
        "rate of "
        "0.5 is known to +- {:.3f}\n",
        forecast.impact.hits, forecast.impact.total, forecast.loops_with_impact,
        forecast.loops_with_impact_interval.lower, forecast.loops_with_impact_interval.upper,
        forecast.detection_width / 2.0);
  if (forecast.loops_without_fault > 0)
    text += fmt::format(
        "no fault: about {:.0f} loops, over which a false alarm rate of 0.05 is known to +- {:.3f}\n",
        forecast.loops_without_fault, forecast.false_alarm_width / 2.0);
  if (forecast.worlds > 0)
    text += worlds_text(forecast);
  text += fmt::format("cost: {} for the study with {} at once; {:.1f} ms a loop",
                      duration_text(found.pilot.seconds), jobs, found.pilot.milliseconds_of_a_loop);
  const char* before = ", of which ";
  for (const StudyForecast::MethodCost& method : forecast.methods) {
    text += fmt::format("{}{} {:.1f}", before, method.method, method.milliseconds);
    before = ", ";
  }
  text += fmt::format(
      "\narchive: loop data of {:.1f} MB with --store flagged, {:.1f} MB with --store all, before "
      "compression\n",
      megabytes(forecast, forecast.to_keep.value), megabytes(forecast, 1.0));
  return text;
}

ExitCode validate(const ValidateArguments& arguments) {
  Progress progress(arguments.quiet);
  const Validation found = validated(arguments, progress);
  print_result(arguments.json ? validation_json(found, arguments.run.jobs)
                              : text_of(found, arguments.run.jobs));
  return ExitCode::done;
}

}  // namespace

void add_validate(CommandSet& commands) {
  const auto options = std::make_shared<ValidateArguments>();
  CLI::App& app = commands.add(
      "validate", "Check a study: what is implausible in it, what it will show, and what it will cost",
      [options] { return validate(*options); });
  app.add_option("STUDY", options->study, "Study file, or name of a shipped study")->required();
  add_experiments(app, options->run.experiments, "Experiments of the pilot (default: 20)");
  add_seed(app, options->run.seed, "Master seed instead of the study's");
  add_methods_option(
      app, options->run.methods,
      "Methods that assess the loops, separated by commas, or all (default: those of the study)");
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_solver(app, options->run.solver);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
