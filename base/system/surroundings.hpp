#pragma once

#include <exception>
#include <stdexcept>
#include <string>

// "Asked, and it failed" and "could not be asked" are two things. The first is an outcome: of a method, a
// plant, a controller, a loop. The second says nothing about them.

namespace mpm {

/// A method, plant or controller could not be asked, through no fault of its own: its process was killed, or
/// there was no process for it. This is never kept as an outcome. A run tries once more, and then stops
/// without it (run_missing()).
class SurroundingsFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Tells whether an error is of this kind. So are std::bad_alloc and std::system_error: no files, processes,
/// threads or memory left. Code that turns exceptions into outcomes lets these pass.
bool is_of_surroundings(const std::exception& error);

/// Returns the text of an error for people. For lack of memory, the text of the standard library says
/// nothing.
std::string what_happened(const std::exception& error);

/// How a process ended.
struct ProcessEnd {
  std::string text;  ///< "ended by signal 11 (Segmentation fault)" or "ended with code 3"
  /// It ended by SIGHUP, SIGINT, SIGKILL or SIGTERM, which no program gets for an error of its own, or with
  /// the code 128 + signal by which a shell reports these signals.
  bool from_outside;
};
/// Reads the end of a process from its status, as waitpid() gives it.
ProcessEnd process_end(int status);

}  // namespace mpm
