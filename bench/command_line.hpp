#pragma once

#include <string>

#include "bench/commands/command_set.hpp"

namespace mpm {

/// How a command line ended.
struct CommandResult {
  ExitCode code;
  std::string message;  ///< for stdout when done (help, version), else for stderr; may be empty
};

/// Reads a command line and runs it: results on stdout, progress on stderr. Wrong usage and wrong input give
/// the code bad_input, any other failure not_finished. Throws nothing.
CommandResult execute(int argc, const char* const* argv);

}  // namespace mpm
