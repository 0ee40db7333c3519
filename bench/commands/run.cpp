#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/validation/study_warnings.hpp"
#include "base/error.hpp"
#include "base/system/surroundings.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/commands/failure_tally.hpp"
#include "bench/commands/narrator.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/replaced_archive.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/parts/loop_ranges.hpp"
#include "bench/parts/part_folder.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"
#include "results/archive/archive.hpp"
#include "results/document/document_text.hpp"
#include "results/summary/summary.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

struct RunArguments {
  std::string study;
  std::string output;
  std::string shard, range;  ///< which part is run; both empty: the whole campaign
  RunOptions run;
  std::vector<std::string> method_files;
  bool overwrite = false;
  std::vector<std::string> changes;  ///< --set, each KEY=VALUE
  bool dry_run = false;
  bool verbose = false;
  bool quiet = false;

  bool is_part() const { return !shard.empty() || !range.empty(); }
};

/// The end of a message about a run that was not finished; empty if there is no shard from which to resume.
std::string how_to_resume(const RunArguments& options, const std::filesystem::path& shards,
                          std::string command_line) {
  if (shards_in(shards).empty())
    return "";
  if (options.run.leftovers == Leftovers::discard)
    command_line = without_discard(std::move(command_line));
  if (options.run.leftovers != Leftovers::resume)
    command_line += " --resume";
  return how_to_go_on("in " + shards.string(), command_line);
}

/// Prints the warnings about a study, without the advice that `validate` gives.
void warn_of(const Study& study, const BasisCase& basis, Progress& progress) {
  std::vector<StudyWarning> warnings = study_warnings(study);
  if (basis.healthy)  // if not, the self-check refuses the run, or the user has allowed it
    for (StudyWarning& warning : basis_warnings(study, basis))
      warnings.push_back(std::move(warning));
  for (const StudyWarning& warning : warnings)
    progress.note(fmt::format("warning: {}: {}", warning.key, warning.found));
}

/// Tells how exact the model of a nonlinear plant is. That of a linear plant is exact, or its worlds say how
/// far it is off.
void tell_model_assumption(const Study& study, const BasisCase& basis, const QpSolverFactory& factory,
                           Progress& progress) {
  if (study.nonlinear && basis.trajectory.status == ControlStatus::ok)
    progress.note(to_string(model_assumption(assessment_context(study, basis, factory))));
}

void run_whole(const RunArguments& options, const Study& study, const RunOptions& run_options,
               CampaignHooks hooks, Narrator& narrator, Progress& progress, const std::string& command_line) {
  std::string summary;
  FailureTally failures;
  hooks.on_end = [&](Campaign& campaign) {
    note_command(campaign, command_line);
    const StudyFindings findings = findings_of(campaign);
    write_archive(options.output, campaign, findings);
    failures.add(findings);
    if (!options.quiet)
      summary = document_text(summary_document(campaign, findings, options.output));
  };
  stream_campaign(study, run_options, narrator.with_stages(std::move(hooks)),
                  shard_folder_of(options.output));
  remove_shards(options.output);
  if (!options.quiet)
    print_result(summary);
  failures.tell(progress);
}

/// The part of the campaign that --shard and --range name.
PartFolder part_of(const RunArguments& options, const Study& study, const RunOptions& run_options) {
  PartFolder part;
  part.study = study_to_run(study, run_options);
  part.options = run_options;
  const std::int64_t experiments = experiment_count(part.study, run_options);
  part.options.experiments = experiments;
  part.loops = experiments + calibration_loops(part.study);
  part.part.loops = {{0, part.loops}};
  if (!options.range.empty())
    part.part.loops = parse_loop_ranges(options.range, part.loops);
  std::optional<PartNumber> number;
  if (!options.shard.empty()) {
    number = parse_part(options.shard, process_environment);
    part.part.loops = piece_of(part.part.loops, number->number, number->of);
    if (options.range.empty())
      part.part.number = number;
  }
  part.path = parts_folder_of(options.output) / part_name(options.range, number);
  return part;
}

void run_one_part(const RunArguments& options, const PartFolder& part, const CampaignHooks& hooks,
                  Progress& progress) {
  if (part.part.number && !part.part.number->launcher.empty())
    progress.note(part.part.number->launcher);
  make_output_folder(part.path.parent_path(), "parts");
  const std::int64_t run = run_part(part, hooks);
  if (!options.quiet)
    print_result(fmt::format("{}: {} of the {} loops of {} ({}), {} of them run now\n", part.path.string(),
                             size_of(part.part.loops), part.loops, part.study.name,
                             part.part.loops.empty() ? "none" : to_string(part.part.loops), run));
}

/// Warns of parts beside the output that belong to another run: `merge` refuses them together with those of
/// this run, and this run does not use them.
void warn_of_other_parts(const RunArguments& options, const Study& study, const RunOptions& run_options,
                         Progress& progress) {
  const std::filesystem::path folder = parts_folder_of(options.output);
  std::error_code no_status;
  if (!std::filesystem::is_directory(folder, no_status))
    return;
  const ShardIdentity identity = shard_identity(study, run_options);
  try {
    for (const std::filesystem::path& path : parts_in(folder)) {
      const PartFolder part = read_part(path);
      require_same(shard_identity(part.study, part.options), identity, path.string());
    }
  } catch (const InputError& error) {
    progress.warn(
        fmt::format("{}; it is left as it is, and `merge` takes parts of one run only", error.what()));
  }
}

ExitCode run(const RunArguments& options, const std::string& command_line) {
  Study study = changed_study(find_study(options.study), parse_study_changes(options.changes), options.study);
  std::vector<std::string> inputs = options.method_files;
  inputs.push_back(options.study);
  require_no_input("--output", options.output, inputs);
  require_output_archive(options.output, "archive");
  RunOptions run_options = options.run;
  const MethodPrograms programs = take_method_files(options.method_files);
  study.assessment.table = programs.table;
  run_options.methods = with_programs(options.run.methods, study.methods, programs.names);
  std::optional<PartFolder> part;
  if (options.is_part())
    part = part_of(options, study, run_options);
  else if (!options.overwrite)
    require_replaceable(options.output, study_to_run(study, run_options));

  Progress progress(options.quiet);
  if (options.dry_run) {
    print_result(dry_run_text(
        {.study = study, .run = run_options, .output = options.output, .part = part ? &*part : nullptr},
        hooks_of(progress)));
    return ExitCode::done;
  }
  if (part || options.run.leftovers == Leftovers::resume)
    warn_of_other_parts(options, study_to_run(study, run_options), run_options, progress);
  Narrator narrator(options.verbose, progress);
  narrator.say_what_is_run(options.study, study, run_options,
                           options.is_part() ? part_text(options.output)
                                             : output_text(options.output, shard_folder_of(options.output)));
  CampaignHooks hooks = hooks_of(progress);
  hooks.on_basis = [&progress, &options](const Study& of_run, const BasisCase& basis) {
    warn_of(of_run, basis, progress);
    tell_model_assumption(of_run, basis, qp_solver_factory(options.run.solver), progress);
  };
  const auto go_on = [&] {
    return how_to_resume(options, part ? part->path : shard_folder_of(options.output), command_line);
  };
  try {
    if (part)
      run_one_part(options, *part, narrator.with_stages(hooks), progress);
    else
      run_whole(options, study, run_options, hooks, narrator, progress, command_line);
  } catch (const OtherRun& error) {
    throw error.with_advice();
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) + go_on());
  } catch (const std::exception& error) {
    throw std::runtime_error(what_happened(error) + go_on());
  }
  return ExitCode::done;
}

void add_part(CLI::App& app, RunArguments& options) {
  add_part_option(app, "--shard", options.shard, "I/N, auto or auto/N",
                  "Run part I/N into the folder OUTPUT.parts, for `merge`. auto: the part that srun, a Slurm "
                  "array or mpirun names; auto/N: also that of an indexed Kubernetes job");
  add_part_option(
      app, "--range", options.range, "A:B",
      "Run the loops A to B-1 as a part, A:B, or several ranges, A:B,C:D; with --shard a part of these");
}

void add_parallel(CLI::App& app, Parallel& parallel) {
  add_choice<Parallel>(
      app, "--parallel", parallel,
      {{"by-solver", Parallel::by_solver},
       {"threads", Parallel::threads},
       {"processes", Parallel::processes}},
      "Run experiments in threads (auto, active-set only) or in worker processes (all solvers)");
}

void add_audit(CLI::App& app, double& share) {
  app.add_option("--audit", share,
                 "Share of the controller's steps that Ipopt solves again as a check, with the solver auto")
      ->check(number_between(0.0, 1.0))
      ->capture_default_str();
}

void add_store(CLI::App& app, StorePolicy& store) {
  add_choice<StorePolicy>(
      app, "--store", store, store_policies(),
      "Loop data to keep: of no experiment, of those with a wrong verdict, of all, or of all with the truth "
      "of the simulation (noise, disturbances, loops with one of two faults alone)");
}

/// `run` must live until the command line is read.
void add_interruption(CLI::App& app, RunOptions& run) {
  CLI::Option* const resume = app.add_flag_callback(
      "--resume", [&run] { run.leftovers = Leftovers::resume; },
      "Resume an interrupted run of this output: run only what is missing");
  app.add_flag_callback(
         "--discard", [&run] { run.leftovers = Leftovers::discard; },
         "Delete what an interrupted run of this output has finished, and start again")
      ->excludes(resume);
  add_shard_interval(app, run.shard_interval);
}

}  // namespace

void add_run(CommandSet& commands) {
  const auto options = std::make_shared<RunArguments>();
  CLI::App& app = commands.add("run", "Run a study and write its archive",
                               [options, &commands] { return run(*options, commands.command_line()); });
  add_path(app, "STUDY", options->study, "Study file, name of a shipped study, or - for stdin")->required();
  add_path(app, "-o,--output", options->output, "Archive to write (HDF5)")->required();
  add_changes(
      app, options->changes,
      "Change a key of the study, KEY=VALUE; may be repeated. The archive contains the changed study");
  add_experiments(app, options->run.experiments, "Run the first N experiments; any N keeps the proportions");
  add_seed(app, options->run.seed, "Master seed instead of the study's");
  add_methods_option(
      app, options->run.methods,
      "Methods that assess the loops, separated by commas, or all (default: those of the study)");
  add_method_files(app, options->method_files);
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_solver(app, options->run.solver);
  add_parallel(app, options->run.parallel);
  add_audit(app, options->run.audit_share);
  add_store(app, options->run.store);
  app.add_flag("--allow-unhealthy-basis", options->run.allow_unhealthy_basis,
               "Run even if the basis case fails its self-check");
  add_part(app, *options);
  add_overwrite(app, options->overwrite);
  add_interruption(app, options->run);
  add_dry_run(app, options->dry_run);
  CLI::Option* const verbose = app.add_flag(
      "--verbose", options->verbose, "Report inputs, decisions and steps, and how long each stage takes");
  add_quiet(app, options->quiet, "No progress and no summary")->excludes(verbose);
}

}  // namespace mpm
