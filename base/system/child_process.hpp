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
/// text says which, with the last output of its stderr. If a program was killed from outside, or if files,
/// processes or memory ran out, that is a failure of the surroundings (is_of_surroundings()), never a
/// ChildFailure.
class ChildFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A program that runs beside this one and answers lines of text with lines of text: messages go to its
/// stdin, answers come from its stdout, and the end of its stderr is kept for error messages.
///
/// Each object belongs to one thread. Objects may be made in any thread, also while others run: the program
/// is spawned, not forked, and inherits no other file. It has its own process group, so that Ctrl-C reaches
/// only this process; the destructor kills the group. If this process dies without running the destructor,
/// the program sees the end of its stdin.
///
/// After a failure of either kind the program is dead: make another one.
class ChildProcess {
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kLongestLine = std::size_t{64} << 20;  ///< longest answer in bytes

  /// Starts the program `command[0]`, which is looked up in PATH, with the arguments after it, in the working
  /// folder of this process. Throws ChildFailure if there is no such program, a failure of the surroundings
  /// if nothing can be started, and UntrustedProgram if nobody has allowed the program (program_trust.hpp).
  explicit ChildProcess(std::vector<std::string> command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a line and an empty line after it: GNU Octave passes a line on only when another one follows.
  /// Throws ChildFailure and SurroundingsFailure.
  void send(std::string_view line, Deadline deadline);

  /// Returns the next line of the program that is not empty, without its line end. Throws as send() does.
  std::string receive(Deadline deadline);

  /// Tells whether this process started the program. A process that was forked off from this one must not ask
  /// the program; there the destructor leaves it alone as well.
  bool is_ours() const;

  /// Processor time that the program has used, in seconds.
  double processor_seconds() const;

  /// Returns a deadline this many seconds from now, at most a century.
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
  std::array<int, 3> ends_;      ///< our ends of its stdin, stdout and stderr; -1: closed
  std::string unsent_, unread_;  ///< bytes for its stdin, and from its stdout
  std::size_t searched_ = 0;     ///< leading bytes of unread_ that hold no line end
  std::string last_errors_;      ///< the end of its stderr
  bool output_is_closed_ = false;
};

}  // namespace mpm
