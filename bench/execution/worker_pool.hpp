#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/execution/stop_request.hpp"

namespace mpm {

enum class TaskEnd : std::int64_t {
  answered,
  crashed,      ///< the work threw, or its process ended, by a fault of its own
  surroundings  ///< the same, but not by its own fault: is_of_surroundings(), ProcessEnd::from_outside
};

/// The outcome of one task.
struct TaskResult {
  std::int64_t id;
  TaskEnd end;
  std::string bytes;  ///< the answer, or the reason why the worker ended
};

/// Worker processes that answer requests, each one at a time.
///
/// Processes and not threads, because Ipopt with sequential MUMPS must not run in two threads of one process.
/// The workers are forked by the constructor from the calling process, which must have no other thread at
/// that time; they inherit its memory, so `work` may refer to anything that the caller has prepared. A worker
/// that crashes, or whose surroundings fail, costs the task it was working on and is replaced. Workers die
/// with the calling process.
class WorkerPool {
 public:
  using Work = std::function<std::string(const std::string& request)>;

  /// `work` runs in a worker; an exception in it is delivered as a TaskResult that did not answer, with its
  /// text. Throws std::system_error if no process or socket can be made, as do the members that replace a
  /// worker.
  WorkerPool(int jobs, Work work);
  ~WorkerPool();  ///< ends the workers, whatever they are doing
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  bool has_idle() const;  ///< some worker has nothing to do
  bool has_busy() const;  ///< some task is under way

  /// Gives a request to an idle worker; there must be one. `id` comes back with the result.
  void start(std::int64_t id, const std::string& request);

  /// The next result, in the order in which results arrive; blocks. Some task must be under way.
  TaskResult wait();

  /// The same, but none when no result arrives within `longest` or a signal arrives first.
  std::optional<TaskResult> wait_for(std::chrono::milliseconds longest);

 private:
  class Worker;

  TaskResult finish(std::size_t position);

  Work work_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

/// The next result, or none after a short while, so that the caller can check whether to stop. A worker that
/// dies after a stop was requested may have died of the same signal. That says nothing about its task, so it
/// counts as no result.
std::optional<TaskResult> next_finding(WorkerPool& pool, const StopRequest& stop);

}  // namespace mpm
