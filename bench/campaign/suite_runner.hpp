#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/findings/leaderboard.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "scenarios/files/suite_file.hpp"

namespace mpm {

/// How a suite is run, and where its archives go.
struct SuiteRun {
  RunOptions run;  ///< of every cell; its seed is that of the cell, and shards are always resumed
  std::filesystem::path folder;  ///< one archive a cell, PLANT.FAMILY.h5
  std::string command;           ///< goes into the archives
  CampaignHooks hooks = {};
  /// Which cells are run, by their place; empty: all of them.
  std::function<bool(std::size_t cell)> is_wanted = {};
  /// Called before each cell: its place, and whether its archive is there already.
  std::function<void(std::size_t cell, bool is_there)> on_cell = {};
};

/// The archive of a cell in the folder of its suite.
std::filesystem::path suite_archive(const Suite& suite, const SuiteCell& cell,
                                    const std::filesystem::path& folder);

/// Runs the cells of a suite one after the other, each as run_campaign() does, and writes their archives. An
/// archive that is there and is what this run would make of the cell (the same text, seed, methods, solver,
/// number of experiments and program) is kept as it is; another one is replaced. So a suite that was stopped
/// goes on by running it again, and the scores are those of one go.
///
/// A cell that cannot be run (its basis case fails the self-check, a method refuses an option of its study)
/// has the reason in `trouble`; the others go on. Of cells that are not wanted nothing comes back. Errors:
/// Interrupted, ArchiveError as run_campaign() and write_archive().
std::vector<CellScores> run_suite(const Suite& suite, const SuiteRun& options);

}  // namespace mpm
