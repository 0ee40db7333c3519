#include "bench/command_run.hpp"

#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "bench/campaign_runner.hpp"
#include "bench/files.hpp"
#include "bench/progress.hpp"
#include "bench/shard_folder.hpp"
#include "bench/stop_signals.hpp"
#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/files/atomic_file.hpp"
#include "results/summary/summary.hpp"
#include "scenarios/study_library.hpp"

namespace mpm {
namespace {

CampaignOptions campaign_options(const RunCommand& command) {
  CampaignOptions options;
  options.experiments = command.experiments;
  options.solver = command.solver;
  options.jobs = command.jobs;
  options.parallel = command.parallel;
  options.audit_share = command.audit_share;
  options.store = command.store;
  options.allow_unhealthy_basis = command.allow_unhealthy_basis;
  options.shards = ShardOptions{shard_folder_of(command.output), command.leftovers, command.shard_interval};
  return options;
}

Campaign run_with_progress(Study study, const RunCommand& command, const StopSignals& signals) {
  CampaignOptions options = campaign_options(command);
  Progress progress(command.experiments.value_or(study.experiment_count()),
                    command.quiet ? Progress::Mode::quiet : Progress::Mode::automatic);
  options.stop = [&] { return signals.received(); };
  options.on_start = [&](std::int64_t done) { progress.start_from(done); };
  options.on_done = [&](const ExperimentRecord& record) {
    progress.advance(record.status == ExperimentStatus::failed);
  };
  options.on_warning = [](const std::string& text) { fmt::print(stderr, "mpmbench: warning: {}\n", text); };
  try {
    Campaign campaign = run_campaign(std::move(study), options);
    progress.finish();
    return campaign;
  } catch (...) {
    progress.finish();
    throw;
  }
}

/// The end of a message about a run that was not finished; empty when no shard is left to go on with.
std::string how_to_go_on(const RunCommand& command, std::string command_line) {
  if (!has_shards(command.output))
    return "";
  constexpr std::string_view kDiscard = " --discard";
  if (command.leftovers == Leftovers::discard)
    command_line.erase(command_line.rfind(kDiscard), kDiscard.size());
  return fmt::format("\nWhat is done is kept in {}. To go on with it:\n  {}{}",
                     shard_folder_of(command.output).string(), command_line,
                     command.leftovers == Leftovers::resume ? "" : " --resume");
}

/// After the archive is written: removes the shards, and what killed runs have left.
void clean_up(const std::filesystem::path& output) {
  ShardFolder shards(shard_folder_of(output));
  shards.clear();
  remove_abandoned_files(output);
}

}  // namespace

ExitCode run(const RunCommand& command, const std::string& command_line) {
  Study study = find_study(command.study);
  if (command.seed)
    study.seed = *command.seed;
  require_output_folder(command.output, "archive");

  const StopSignals signals;
  try {
    Campaign campaign = run_with_progress(std::move(study), command, signals);
    campaign.info.command = command_line;
    write_archive(command.output, campaign);
    clean_up(command.output);
    if (!command.quiet)
      fmt::print("{}", summary_text(campaign, command.output));
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted& error) {
    throw std::runtime_error(
        fmt::format("{}: {}{}", signals.name(), error.what(), how_to_go_on(command, command_line)));
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what() + how_to_go_on(command, command_line));
  }
  return ExitCode::done;
}

}  // namespace mpm
