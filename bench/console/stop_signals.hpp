#pragma once

#include <string_view>

#include <signal.h>

namespace mpm {

/// Turns Ctrl-C (SIGINT) and SIGTERM into a request to stop, as long as the object lives. It does so even if
/// the caller of the program ignores these signals: a shell ignores the SIGINT of background jobs in a
/// script, but whoever sends one to such a job means it.
///
/// The first signal of each kind is only noted; the second one finds the default action again and ends the
/// process at once. Processes that are forked meanwhile inherit these handlers, because a Ctrl-C goes to them
/// too, and only their parent may decide when they end.
///
/// Work that has not ended 1.7 s after the first signal is given up: the process says so and ends at once,
/// with the exit code of a command that did not finish. It leaves behind what a killed process leaves. At
/// most one object at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one of the signals has come. From any thread.
  bool received() const;

  /// "SIGINT", "SIGTERM", or a text which says that the served process has ended; empty if nothing has come.
  std::string_view name() const;

 private:
  struct sigaction interrupt_ {};
  struct sigaction terminate_ {};
  struct sigaction alarm_ {};
};

/// Makes the end of the process that this one serves a request to stop, too. A process that starts this
/// program for itself alone sets the environment variable MPMBENCH_SERVES to "PID PID-NAMESPACE", the
/// namespace as in /proc/PID/ns/pid. If that process ends after this call, this one ends 1.7 s later as
/// above, whether a StopSignals lives or not. A thread waits for it; that thread holds no lock when others
/// fork. Does nothing without the variable, or if it names another namespace. Errors: std::system_error if no
/// thread can be made.
void stop_with_served_process();

}  // namespace mpm
