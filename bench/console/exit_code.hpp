#pragma once

namespace mpm {

/// Exit codes of the program (README.md).
enum class ExitCode : int {
  done = 0,
  comparison_failed = 1,  ///< a replay that differs, a gate that stops a campaign
  bad_input = 2,          ///< wrong usage, or a wrong file
  not_finished = 3,       ///< the run could not be finished
};

}  // namespace mpm
