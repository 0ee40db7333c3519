#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/validation/study_forecast.hpp"
#include "analysis/validation/study_warnings.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "results/text/number_json.hpp"
#include "scenarios/study_library.hpp"

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

/// What validate has found out of a study.
struct Validation {
  Campaign pilot;
  StudyForecast forecast;
  std::vector<StudyWarning> warnings;
  double seconds = 0.0;  ///< the whole study, with as many jobs
  double milliseconds_of_a_loop = 0.0;
};

void append(std::vector<StudyWarning> more, std::vector<StudyWarning>& warnings) {
  std::move(more.begin(), more.end(), std::back_inserter(warnings));
}

/// The basis case, and a pilot of the study where the basis case runs to its end.
Validation validated(const ValidateArguments& arguments, Progress& progress) {
  using PilotClock = std::chrono::steady_clock;
  Study study = find_study(arguments.study);
  const int calibration_loops = study.calibration ? study.calibration->healthy + study.calibration->ud : 0;
  study.calibration.reset();  // the pilot needs none
  Validation found;
  found.warnings = study_warnings(study);
  RunOptions options = arguments.run;
  options.experiments =
      std::min<std::int64_t>(options.experiments.value_or(kPilot), study.experiment_count());
  options.store = StorePolicy::none;
  options.audit_share = 0.0;
  options.allow_unhealthy_basis = true;
  CampaignHooks hooks = hooks_of(progress);
  PilotClock::time_point start;
  hooks.on_start = [&, begin = hooks.on_start](std::int64_t done, std::int64_t count) {
    start = PilotClock::now();
    begin(done, count);
  };
  try {
    found.pilot = run_campaign(study, options, hooks);
  } catch (const UnhealthyBasis&) {  // which does not run to its end: the warnings may say why
    for (const StudyWarning& warning : found.warnings)
      progress.warn(fmt::format("warning: {}", to_string(warning)));
    throw;
  }
  const double loops = std::chrono::duration<double>(PilotClock::now() - start).count();
  append(basis_warnings(found.pilot.study, found.pilot.basis), found.warnings);
  found.forecast = forecast(found.pilot.study, found.pilot.records);
  append(forecast_warnings(found.pilot.study, found.forecast, found.pilot.records), found.warnings);
  const auto count = static_cast<double>(*options.experiments);
  const double at_once = std::min(count, static_cast<double>(options.jobs));
  found.milliseconds_of_a_loop = 1e3 * loops * at_once / count;
  found.seconds = found.pilot.info.seconds - loops +
                  loops / count * static_cast<double>(found.forecast.experiments + calibration_loops);
  return found;
}

double megabytes(const StudyForecast& forecast, double share) {
  return 1e-6 * share * static_cast<double>(forecast.experiments) *
         static_cast<double>(forecast.bytes_of_a_loop);
}

std::string json_text(const Validation& found, int jobs) {
  const StudyForecast& forecast = found.forecast;
  Json json{
      {"study", found.pilot.study.name},
      {"warnings", Json::array()},
      {"basis", {{"healthy", found.pilot.basis.healthy}, {"explanation", found.pilot.basis.explanation}}},
      {"experiments", forecast.experiments},
      {"pilot", found.pilot.records.size()},
      {"feasible", rate_json(forecast.feasible)},
      {"impact", rate_json(forecast.impact)},
      {"loops_with_impact", forecast.loops_with_impact},
      {"loops_without_fault", forecast.loops_without_fault},
      {"detection_width", forecast.detection_width},
      {"false_alarm_width", forecast.false_alarm_width},
      {"milliseconds_of_a_loop", found.milliseconds_of_a_loop},
      {"methods", Json::array()},
      {"jobs", jobs},
      {"seconds", found.seconds},
      {"megabytes",
       {{"flagged", megabytes(forecast, forecast.to_keep.value)}, {"all", megabytes(forecast, 1.0)}}}};
  for (const StudyWarning& warning : found.warnings)
    json["warnings"].push_back({{"key", warning.key}, {"found", warning.found}, {"advice", warning.advice}});
  for (const StudyForecast::MethodCost& method : forecast.methods)
    json["methods"].push_back({{"name", method.method}, {"milliseconds", method.milliseconds}});
  return json.dump(2) + "\n";
}

/// "3.2 s", "12 min", "3.1 h"
std::string duration(double seconds) {
  return seconds < 120.0    ? fmt::format("{:.1f} s", seconds)
         : seconds < 7200.0 ? fmt::format("{:.0f} min", seconds / 60.0)
                            : fmt::format("{:.1f} h", seconds / 3600.0);
}

std::string text_of(const Validation& found, int jobs) {
  const StudyForecast& forecast = found.forecast;
  const Study& study = found.pilot.study;
  std::string text = fmt::format("{}: {}\n", study.name, study.title);
  for (const StudyWarning& warning : found.warnings)
    text += fmt::format("warning: {}\n", to_string(warning));
  if (found.warnings.empty())
    text += "no warnings\n";
  text += fmt::format("basis case: {}\n", found.pilot.basis.explanation);
  text += fmt::format("pilot: {} of {} experiments, {} feasible\n", found.pilot.records.size(),
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
  text += fmt::format("cost: {:.1f} ms a loop, {} for the study with {} at once; per loop",
                      found.milliseconds_of_a_loop, duration(found.seconds), jobs);
  for (const StudyForecast::MethodCost& method : forecast.methods)
    text += fmt::format(" {} {:.1f} ms", method.method, method.milliseconds);
  text += fmt::format(
      "\narchive: loop data of {:.1f} MB with --store flagged, {:.1f} MB with --store all, before "
      "compression\n",
      megabytes(forecast, forecast.to_keep.value), megabytes(forecast, 1.0));
  return text;
}

ExitCode validate(const ValidateArguments& arguments) {
  Progress progress(arguments.quiet);
  const Validation found = validated(arguments, progress);
  print_result(arguments.json ? json_text(found, arguments.run.jobs) : text_of(found, arguments.run.jobs));
  return ExitCode::done;
}

}  // namespace

void add_validate(CommandSet& commands) {
  const auto options = std::make_shared<ValidateArguments>();
  CLI::App& app =
      commands.add("validate", "What is implausible in a study, what it will show, and what it will cost",
                   [options] { return validate(*options); });
  app.add_option("STUDY", options->study, "Study file, or name of a shipped study")->required();
  add_experiments(app, options->run.experiments, "Experiments of the pilot; 20 without it");
  add_seed(app, options->run.seed, "Master seed instead of the study's");
  add_methods_option(app, options->run.methods,
                     "Methods that assess the loops, separated by commas, or all; in place of the study's");
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_solver(app, options->run.solver);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
