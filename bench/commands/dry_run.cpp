#include "bench/commands/dry_run.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include "base/error.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/campaign/kept_campaign.hpp"
#include "bench/campaign/study_pilot.hpp"
#include "bench/console/output.hpp"
#include "bench/shards/shard_folder.hpp"

namespace mpm {
namespace {

constexpr double kMega = 1e6;
constexpr std::int64_t kFewestTimed = 4;

/// Share of the loops whose data is kept.
double kept_share(const RunOptions& options, const StudyForecast& forecast) {
  return options.store == StorePolicy::all || options.store == StorePolicy::truth ? 1.0
         : options.store == StorePolicy::flagged                                  ? forecast.to_keep.value
                                                                                  : 0.0;
}

/// The peak memory of this process so far, pilot included.
double peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  constexpr double kKibi = 1024.0;
  return static_cast<double>(usage.ru_maxrss) * kKibi / kMega;
}

std::string leftovers_text(const std::filesystem::path& shards, Leftovers leftovers) {
  const std::size_t count = shards_in(shards).size();
  if (count == 0)
    return "";
  return fmt::format("found: {} shards of an interrupted run in {}, {}\n", count, shards.string(),
                     leftovers == Leftovers::refuse    ? "the run is refused without --resume or --discard"
                     : leftovers == Leftovers::discard ? "which are deleted"
                                                       : "which the run resumes: it takes less time");
}

const char* basis_verdict(bool healthy, const RunOptions& options) {
  return healthy                         ? "passed"
         : options.allow_unhealthy_basis ? "FAILED"
                                         : "FAILED: the run is refused without --allow-unhealthy-basis";
}

std::string loops_text(const Study& study, std::int64_t experiments) {
  const std::int64_t calibration = calibration_loops(study);
  return fmt::format("{} experiments{}", experiments,
                     calibration > 0 ? fmt::format(" and {} calibration loops", calibration) : "");
}

/// How long the studies take together. Runs and times the first loops of a few of them, evenly spread.
std::string together_time(const std::vector<const IntendedStudy*>& studies, const RunOptions& options,
                          const CampaignHooks& hooks) {
  constexpr std::size_t kMostTimed = 8;
  const std::size_t step = (studies.size() + kMostTimed - 1) / kMostTimed;
  double seconds = 0.0;
  std::size_t timed = 0;
  for (std::size_t place = 0; place < studies.size(); place += step) {
    try {
      seconds += run_pilot(studies[place]->study, options, std::max<std::int64_t>(kFewestTimed, options.jobs),
                           {.stop = hooks.stop, .on_warning = hooks.on_warning})
                     .seconds;
      ++timed;
    } catch (const InputError&) {
      continue;  // a study that cannot be run takes hardly any time
    }
  }
  if (timed == 0)
    return "time: unknown, none of the studies that were tried can be run\n";
  return fmt::format(
      "time: about {}, from the first loops of {} of them\n",
      duration_text(seconds / static_cast<double>(timed) * static_cast<double>(studies.size())), timed);
}

}  // namespace

void add_dry_run(CLI::App& app, bool& dry_run) {
  app.add_flag("--dry-run", dry_run,
               "List what would be run and written and how long it takes; write nothing");
}

void add_untimed_dry_run(CLI::App& app, bool& dry_run) {
  app.add_flag("--dry-run", dry_run, "List what would be run and written; run and write nothing");
}

std::string solver_text(const Study& study, const RunOptions& options) {
  const double audited = audited_share(study, options);
  return fmt::format(
      "solver: {}{}{}, {} loops at once in {}",
      study.controller_program ? "none, the controller is a program" : options.solver,
      options.solver == "auto" && !study.controller_program
          ? " (active-set, Ipopt for answers that are not certified)"
          : "",
      audited > 0 ? fmt::format(", audit of {:g} % of the steps by Ipopt", 100.0 * audited) : "",
      options.jobs, runs_in_threads(study, options) ? "threads" : "worker processes");
}

std::string output_text(const std::string& output, const std::filesystem::path& shards) {
  std::error_code no_status;
  return fmt::format("{}{}; until then shards in {}", output,
                     std::filesystem::exists(output, no_status) ? ", replacing the file that is there" : "",
                     shards.string());
}

std::string part_text(const std::string& output) {
  return fmt::format("shards in {}, for `mpmbench merge`", parts_folder_of(output).string());
}

std::string dry_run_text(const std::vector<IntendedStudy>& studies, const RunOptions& options,
                         const CampaignHooks& hooks) {
  std::string text;
  std::int64_t loops = 0;
  std::vector<const IntendedStudy*> to_run;
  for (const IntendedStudy& study : studies) {
    const bool kept = kept_campaign(study.archive, study.study, options, {}).has_value();
    const std::int64_t of_study = experiment_count(study.study, options) + calibration_loops(study.study);
    loops += kept ? 0 : of_study;
    if (!kept)
      to_run.push_back(&study);
    text += fmt::format("{}: {} loops, {}{}\n", study.name, of_study, study.archive.string(),
                        kept ? ", done already" : "");
  }
  text += fmt::format("together: {} studies, {} loops to run, with {} at once by {}\n", studies.size(), loops,
                      options.jobs, options.solver);
  if (!to_run.empty())
    text += together_time(to_run, options, hooks);
  return text + "nothing was written\n";
}

std::string dry_run_text(const IntendedRun& intended, const CampaignHooks& hooks) {
  const RunOptions& options = intended.run;
  const Study study = study_to_run(intended.study, options);
  const std::int64_t experiments = experiment_count(study, options);
  const std::int64_t all = experiments + calibration_loops(study);
  const std::int64_t loops = intended.part != nullptr ? size_of(intended.part->part.loops) : all;
  const StudyPilot pilot =
      run_pilot(intended.study, options, std::max<std::int64_t>(kFewestTimed, options.jobs), hooks);
  const auto timed = static_cast<double>(pilot.campaign.records.size());
  const double share = all > 0 ? static_cast<double>(loops) / static_cast<double>(all) : 0.0;
  const double kept = static_cast<double>(experiments) * share * kept_share(options, pilot.forecast) *
                      static_cast<double>(pilot.forecast.bytes_of_a_loop) / kMega;

  std::string text = fmt::format("study: {}: {}, seed {}\n", study.name, study.title, study.seed);
  text += fmt::format("loops: {}", loops_text(study, experiments));
  if (intended.part != nullptr)
    text += fmt::format(", of which this part runs {}", loops);
  text += fmt::format(" of {} samples\nmethods: {}\n{}\n", study.simulation.samples,
                      fmt::join(study.methods, ", "), solver_text(study, options));
  text += fmt::format("basis case: {}: {}\n", basis_verdict(pilot.campaign.basis.healthy, options),
                      pilot.campaign.basis.explanation);
  text += fmt::format(
      "time: about {} (basis case {:.2f} s; {:.3g} ms a loop, from {:g} loops that were timed{})\n",
      duration_text(pilot.basis_seconds + (pilot.seconds - pilot.basis_seconds) * share), pilot.basis_seconds,
      pilot.milliseconds_of_a_loop, timed, audited_share(study, options) > 0 ? ", without the audit" : "");
  text += fmt::format("memory: about {:.0f} MB, including {:.1f} MB of stored loop data\n",
                      peak_megabytes() + kept, kept);
  text += fmt::format("files: {}\n", intended.part != nullptr
                                         ? part_text(intended.output)
                                         : output_text(intended.output, shard_folder_of(intended.output)));
  text += leftovers_text(intended.part != nullptr ? intended.part->path : shard_folder_of(intended.output),
                         options.leftovers);
  return text + "nothing was written\n";
}

}  // namespace mpm
