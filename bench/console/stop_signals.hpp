#pragma once

#include <string_view>

#include <signal.h>

namespace mpm {

/// Turns Ctrl-C (SIGINT) and SIGTERM into a request to stop, for as long as it lives. Also where the
/// caller of the program ignores them: a shell does so with the SIGINT of background jobs in a script, and
/// whoever sends one to such a job means it.
///
/// The first of each is noted only; the second one finds the default action again and ends the process at
/// once. Processes that are forked meanwhile inherit this: a Ctrl-C goes to them too, and must leave it to
/// their parent when they end.
///
/// Work that has not ended 1.7 s after the first is given up: the process says so and ends at once, with the
/// exit code of a command that did not finish. It leaves what a killed one leaves. At most one object at a
/// time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one of the signals has come. From any thread.
  bool received() const;

  /// "SIGINT", "SIGTERM", or that the process that this one serves has ended; empty when nothing has come.
  std::string_view name() const;

 private:
  struct sigaction interrupt_ {};
  struct sigaction terminate_ {};
  struct sigaction alarm_ {};
};

/// A process that starts this program for itself alone says so in the variable MPMBENCH_SERVES of the
/// environment: "PID PID-NAMESPACE", the second one as /proc/PID/ns/pid has it. From this call on the end of
/// that process is a request to stop, too, and this one ends 1.7 s after it as above, whether a StopSignals
/// lives or not. A thread waits for it, which holds no lock when others fork. Does nothing without the
/// variable, or with that of another namespace. Errors: std::system_error when there is no thread.
void stop_with_served_process();

}  // namespace mpm
