#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/campaign/kept_campaign.hpp"
#include "bench/console/progress.hpp"
#include "bench/execution/run_options.hpp"

namespace mpm {

/// One of the studies that a command runs one after the other, and keeps.
struct IntendedStudy {
  std::string place;  ///< "cell 3 of 44"
  std::string name;
  const Study& study;
  std::filesystem::path archive;
};

/// Refuses archives in this folder that cannot be written and, unless they may be overwritten, those that
/// hold other results. Makes the folder.
void require_archives(const std::vector<IntendedStudy>& studies, const std::filesystem::path& folder,
                      const RunOptions& options, bool overwrite);

/// What a command makes of the run of the study at a place among them.
using TakeRun = std::function<void(std::size_t place, KeptRun run)>;

/// Runs them, each unless its archive is there, and shows how far all of them have come. A study that cannot
/// be run is a warning. Throws std::runtime_error, which says how to resume, where it is stopped; other
/// errors: as run_unless_kept().
void run_series(const std::vector<IntendedStudy>& studies, const RunOptions& options, Progress& progress,
                const std::string& output, const std::string& command_line, const TakeRun& take);

}  // namespace mpm
