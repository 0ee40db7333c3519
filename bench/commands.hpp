#pragma once

#include <string>

#include "bench/options.hpp"

namespace mpm {

/// Exit codes of the program (docs/architecture.md).
enum class ExitCode : int {
  done = 0,
  comparison_failed = 1,  ///< a replay that differs, a gate that stops a campaign
  bad_input = 2,          ///< wrong usage, or a file that is not what it should be
  not_finished = 3,       ///< the run could not be finished
};

/// Runs a command: results on stdout, progress and messages on stderr. `command_line` goes into the archive.
ExitCode execute(const Command& command, const std::string& command_line);

}  // namespace mpm
