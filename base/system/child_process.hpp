#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "base/system/surroundings.hpp"

namespace mpm {

/// A program gave no answer: it could not be started, ended, took too long, or sent a line without end. The
/// text says which, with the last output of its stderr. A program that was killed from outside, or for which
/// files, processes or memory were lacking, is a failure of the surroundings (is_of_surroundings()), never a
/// ChildFailure.
class ChildFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A program that runs beside this one and answers lines of text by lines of text: messages go to its stdin,
/// answers come from its stdout, and the end of its stderr is kept for messages about it.
///
/// Each object belongs to one thread. Objects may be made in any thread, also while others run: the program
/// is spawned, not forked, and inherits no other file. It has a process group of its own, so that Ctrl-C
/// reaches this program alone; the destructor kills the group. When this process dies without one, the
/// program sees the end of its stdin.
///
/// After a failure of either kind the program is dead: make another one.
class ChildProcess {
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kLongestLine = std::size_t{64} << 20;  ///< bytes of an answer

  /// Starts the program `command[0]`, which is looked for in PATH, with the arguments after it, in the
  /// working folder of this process. Throws ChildFailure when there is no such program, a failure of the
  /// surroundings when nothing can be started, UntrustedProgram when nobody has allowed it
  /// (program_trust.hpp).
  explicit ChildProcess(std::vector<std::string> command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a line, and an empty one behind it: GNU Octave hands out a line only when another one follows.
  /// Throws ChildFailure and SurroundingsFailure.
  void send(std::string_view line, Deadline deadline);

  /// The next line of the program that is not empty, without its end. Throws the same.
  std::string receive(Deadline deadline);

  /// Was the program started by this process, not by the one that this was forked from? A program of another
  /// process is left alone, also by the destructor, and must not be asked.
  bool is_ours() const;

  /// Processor time that the program has used, in seconds.
  double processor_seconds() const;

  /// A deadline this many seconds from now; a century for longer ones.
  static Deadline in_seconds(double seconds);

 private:
  void pump(Deadline deadline);
  void read_errors();
  void kill_and_reap();
  [[noreturn]] void fail_by_end();
  [[noreturn]] void fail(const ProcessEnd& what);

  std::string name_;             ///< the command, for messages
  pid_t owner_;                  ///< the process that started it
  pid_t pid_ = -1;               ///< -1: reaped
  std::array<int, 3> ends_;      ///< ours of its stdin, stdout and stderr; -1: closed
  std::string unsent_, unread_;  ///< bytes for its stdin, and from its stdout
  std::size_t searched_ = 0;     ///< bytes of unread_ without an end of line
  std::string last_errors_;      ///< the end of its stderr
  bool output_is_closed_ = false;
};

}  // namespace mpm
