#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

namespace mpm {

/// gnuplot is not installed, or could not draw: the text says which and what to do.
class GnuplotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs `program` (gnuplot, found through PATH) as a child process on this script, with no start-up file of
/// the user, and returns what it writes to its standard output. The script sets a terminal and no output. All
/// that passes between the two goes through files in a temporary folder, so that neither waits for the other.
///
/// The script must hold foreign text in single quotes or data blocks only (plot_text.hpp): elsewhere gnuplot
/// runs what stands in backquotes.
///
/// Errors: GnuplotError when the program cannot be started, ends with another code than 0 or writes
/// nothing, or has not ended after `patience`; it is killed then.
std::string run_gnuplot(const std::string& script, const std::string& program = "gnuplot",
                        std::chrono::milliseconds patience = std::chrono::minutes(2));

}  // namespace mpm
