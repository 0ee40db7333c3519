#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/execution/stop_request.hpp"
#include "bench/shards/shard_store.hpp"

namespace mpm {

/// The outcome of a loop.
struct LoopResult {
  std::string bytes;        ///< what is kept of it
  bool failed = false;      ///< worth mentioning to the user
  bool unfinished = false;  ///< no thread can finish it: a worker process goes on with `bytes`
  std::string aside = {};   ///< for LoopWork::on_aside; empty: nothing
};

/// How loops are run, or whatever takes long: each a function of its key alone.
struct LoopWork {
  using Thread = std::function<LoopResult(std::int64_t key)>;

  int jobs = 1;  ///< how many run at once
  /// Makes the worker of one thread, before the first thread starts. Empty: every loop runs in a worker
  /// process.
  std::function<Thread()> thread = {};
  /// Threads take neighbours of one group together, as far as that keeps all of them busy: what a thread
  /// learns for one loop serves the others. Empty: loops have nothing in common.
  std::function<std::int64_t(std::int64_t key)> group = {};
  /// What a worker process does with a loop, of which a thread has `begun` bytes or nothing. Empty: threads
  /// finish every loop.
  std::function<LoopResult(std::int64_t key, const std::string& begun)> process = {};
  /// What is kept of a loop over which a worker process died by a fault of its own, `why`; none: it is tried
  /// once more. `again`: it was tried once more.
  std::function<std::optional<LoopResult>(std::int64_t key, const std::string& begun, const std::string& why,
                                          bool again)>
      lost = {};

  StopRequest stop = {};
  std::string_view what = "experiments";  ///< for the message of Interrupted
  /// Called once before the first one: `done` of `count` were there already.
  std::function<void(std::int64_t done, std::int64_t count)> on_start = {};
  /// Called after each one, in the order of completion; one call at a time, from any thread.
  std::function<void(bool failed)> on_done = {};
  /// Receives the results of a loop besides its bytes; one call at a time, from any thread.
  std::function<void(std::int64_t key, std::string aside)> on_aside = {};
  /// Called for each loop that is tried once more; one call at a time, from any thread. May be empty.
  std::function<void(const std::string&)> on_warning = {};
};

/// Runs those of the loops that the store lacks, in this order, and keeps them in it: the one place where
/// loops run. Threads are those of OpenMP, with a dynamic schedule; worker processes are for what must not
/// run in threads or may crash, and are forked before the first thread starts. The store has the same bytes
/// however many run at once, and in whatever order they are done.
///
/// A loop whose surroundings fail (is_of_surroundings()), such as a worker process that is killed from
/// outside, is run once more by a new thread or process. If they fail again, nothing is kept of it, and the
/// run stops.
///
/// When a stop is requested, no more are given out, and those in worker processes, which may take minutes,
/// are given up. Throws Interrupted when not all are done, with what the surroundings did where that is why,
/// and otherwise what the first loop in a thread throws; InputError that a worker process throws;
/// ArchiveError of the store.
void run_missing(ShardStore& store, const std::vector<std::int64_t>& keys, const LoopWork& work);

}  // namespace mpm
