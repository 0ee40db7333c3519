#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace mpm {

/// What became of one task.
struct TaskResult {
  std::int64_t index;
  bool crashed;       ///< the worker process ended before it answered
  std::string bytes;  ///< the answer, or what is known of the end of the worker
};

/// Runs tasks 0 <= index < count in `jobs` worker processes and hands every result to `deliver`, in the order
/// in which the results arrive.
///
/// Processes and not threads, because Ipopt with sequential MUMPS must not run in two threads of one process.
/// The workers are forked from the calling process, which must have no other thread at that time; they
/// inherit its memory, so `work` may refer to anything that the caller has prepared. A worker that crashes
/// costs the task it was working on and is replaced. Workers die with the calling process.
///
/// `work` runs in a worker; an exception in it is delivered as a crash with its text. `deliver` runs in the
/// caller; when it throws, the workers are ended and the exception goes on.
///
/// Throws std::system_error when no process or socket can be made.
void run_in_workers(std::int64_t count, int jobs, const std::function<std::string(std::int64_t)>& work,
                    const std::function<void(TaskResult)>& deliver);

}  // namespace mpm
