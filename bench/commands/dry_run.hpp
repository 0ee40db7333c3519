#pragma once

#include <string>
#include <vector>

#include "bench/campaign/campaign_hooks.hpp"
#include "bench/commands/study_series.hpp"
#include "bench/parts/part_folder.hpp"

namespace CLI {
class App;
}

namespace mpm {

// What a command says about its work: instead of doing it (--dry-run), or while doing it (--verbose).

void add_dry_run(CLI::App& app, bool& dry_run);
/// The same for a command that does not estimate the time.
void add_untimed_dry_run(CLI::App& app, bool& dry_run);

/// A requested run.
struct IntendedRun {
  const Study& study;
  const RunOptions& run;  ///< with the methods of programs
  std::string output;
  const PartFolder* part = nullptr;  ///< none: the whole campaign
};

/// Says what the run would do: loops, methods, time, memory and files. Runs and times a few loops to estimate
/// the time; writes nothing. Errors: as run_campaign().
std::string dry_run_text(const IntendedRun& intended, const CampaignHooks& hooks);

/// The same for several studies, with the time that they take together. Runs and times a few loops of some of
/// the studies.
std::string dry_run_text(const std::vector<IntendedStudy>& studies, const RunOptions& options,
                         const CampaignHooks& hooks);

/// "solver: active-set, 2 loops at once in threads": what solves the problems, and how many loops run at
/// once.
std::string solver_text(const Study& study, const RunOptions& options);

/// "out.h5; until then shards in out.h5.shards".
std::string output_text(const std::string& output, const std::filesystem::path& shards);

/// The same for a part of a run.
std::string part_text(const std::string& output);

}  // namespace mpm
