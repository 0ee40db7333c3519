#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaign/campaign_hooks.hpp"
#include "bench/execution/run_options.hpp"

// Campaigns whose archive is kept for the next time, and read as stream_archive() reads it.

namespace mpm {

/// The campaign in this archive, when it is there and whole and what this run would make of the study: the
/// same text, seed, methods, solver, number of experiments and program. Shards beside it are removed: they
/// are of a run that was killed between archive and clean-up. Of an archive that cannot be read `warn`,
/// unless it is empty, receives the reason why it will be replaced.
std::optional<Campaign> kept_campaign(const std::filesystem::path& archive, const Study& study,
                                      const RunOptions& options,
                                      const std::function<void(const std::string&)>& warn);

/// The same, whatever methods have judged its loops.
std::optional<Campaign> kept_loops(const std::filesystem::path& archive, const Study& study,
                                   const RunOptions& options,
                                   const std::function<void(const std::string&)>& warn);

/// Those of the methods of `study` whose answers the campaign lacks, or has from another version of them.
std::vector<std::string> methods_without(const Campaign& campaign, const Study& study);

/// Runs the study, going on with the shards that an interrupted run has left unless they are of another study
/// or program, and writes the archive. Errors: as run_campaign(), write_archive() and
/// stream_archive().
Campaign run_and_keep(const std::filesystem::path& archive, const Study& study, RunOptions options,
                      CampaignHooks hooks, const std::string& command);

/// The outcome of a study whose archive is kept.
struct KeptRun {
  std::optional<Campaign> campaign = {};  ///< none: it cannot be run
  std::string trouble = {};               ///< why
};

/// One or the other: a study is run unless its archive is there, which `on_start` is told before. One that
/// cannot be run (its basis case fails the self-check, a method refuses an option of it) leaves no archive.
/// Errors: Interrupted, ArchiveError as run_and_keep(); BrokenPromise.
KeptRun run_unless_kept(const std::filesystem::path& archive, const Study& study, const RunOptions& options,
                        const CampaignHooks& hooks, const std::string& command,
                        const std::function<void(bool is_there)>& on_start);

}  // namespace mpm
