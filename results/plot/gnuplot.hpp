#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

namespace mpm {

/// Thrown if gnuplot is not installed, or could not draw. The text says which of the two, and what to do.
class GnuplotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs `program` (gnuplot, found through PATH) as a child process on this script, without a start-up file of
/// the user, and returns what it writes to its standard output. The script sets a terminal and no output. The
/// two processes exchange everything through files in a temporary folder, so that neither waits for the
/// other.
///
/// Foreign text in the script must be in single quotes or data blocks (plot_text.hpp): anywhere else gnuplot
/// runs text in backquotes as a command.
///
/// Errors: GnuplotError if the program cannot be started, ends with an exit code other than 0, writes
/// nothing, or has not ended after `patience`. In the last case it is killed.
std::string run_gnuplot(const std::string& script, const std::string& program = "gnuplot",
                        std::chrono::milliseconds patience = std::chrono::minutes(2));

}  // namespace mpm
