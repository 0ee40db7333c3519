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

/// One of the studies that a command runs one after the other and whose archives it keeps.
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

/// What a command does with the run of the study at this place of the list.
using TakeRun = std::function<void(std::size_t place, KeptRun run)>;

/// Runs the studies, except those whose archive is there, and shows the progress of all of them. A study that
/// cannot be run gives a warning. Throws std::runtime_error, which says how to resume, if it is stopped.
/// Other errors: as run_unless_kept().
void run_series(const std::vector<IntendedStudy>& studies, const RunOptions& options, Progress& progress,
                const std::string& output, const std::string& command_line, const TakeRun& take);

}  // namespace mpm
