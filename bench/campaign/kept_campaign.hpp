#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaign/campaign_hooks.hpp"
#include "bench/execution/run_options.hpp"

// Campaigns whose archive is kept for the next run, which reads it by stream_archive().

namespace mpm {

/// Returns the campaign in this archive if the archive is intact and is what this run would make of the
/// study: the same text, seed, methods, solver, number of experiments and program. Removes shards beside it,
/// which a run left that was killed between archive and clean-up. If the archive cannot be read, `warn`,
/// unless it is empty, receives the reason why it will be replaced.
std::optional<Campaign> kept_campaign(const std::filesystem::path& archive, const Study& study,
                                      const RunOptions& options,
                                      const std::function<void(const std::string&)>& warn);

/// The same, whatever methods have judged its loops; leaves shards alone.
std::optional<Campaign> kept_loops(const std::filesystem::path& archive, const Study& study,
                                   const RunOptions& options,
                                   const std::function<void(const std::string&)>& warn);

/// Returns the methods of `study` whose answers the campaign lacks, or has from another version of the
/// method.
std::vector<std::string> methods_without(const Campaign& campaign, const Study& study);

/// Runs the study and writes the archive. Resumes from the shards that an interrupted run has left, unless
/// they are of another study or program. Errors: as run_campaign(), write_archive() and stream_archive().
Campaign run_and_keep(const std::filesystem::path& archive, const Study& study, RunOptions options,
                      CampaignHooks hooks, const std::string& command);

/// The outcome of a study whose archive is kept.
struct KeptRun {
  std::optional<Campaign> campaign = {};  ///< none: the study cannot be run
  std::string trouble = {};               ///< why it cannot be run
};

/// Reads the archive of the study if it is there, otherwise runs the study; before that it tells `on_start`
/// which of the two it does. A study that cannot be run (its basis case fails the self-check, or a method
/// refuses one of its options) leaves no archive. Errors: Interrupted, ArchiveError as run_and_keep();
/// BrokenPromise.
KeptRun run_unless_kept(const std::filesystem::path& archive, const Study& study, const RunOptions& options,
                        const CampaignHooks& hooks, const std::string& command,
                        const std::function<void(bool is_there)>& on_start);

}  // namespace mpm
