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

/// How loops, or other long pieces of work, are run. The result of each is a function of its key alone.
struct LoopWork {
  using Thread = std::function<LoopResult(std::int64_t key)>;

  int jobs = 1;  ///< how many run at once
  /// Makes the worker of one thread, before the first thread starts. Empty: every loop runs in a worker
  /// process.
  std::function<Thread()> thread = {};
  /// A thread takes neighbours of one group together, as far as all threads stay busy: what it learns for one
  /// loop serves the others. Empty: loops have nothing in common.
  std::function<std::int64_t(std::int64_t key)> group = {};
  /// Runs a loop in a worker process. `begun` are the bytes that a thread has left of it; empty if there are
  /// none. Empty function: threads finish every loop.
  std::function<LoopResult(std::int64_t key, const std::string& begun)> process = {};
  /// Returns what to store of a loop whose worker process died by a fault of its own, `why`; none: the loop
  /// is tried once more. `again`: this was the second try.
  std::function<std::optional<LoopResult>(std::int64_t key, const std::string& begun, const std::string& why,
                                          bool again)>
      lost = {};

  StopRequest stop = {};
  std::string_view what = "experiments";  ///< for the message of Interrupted
  /// Called once before the first loop: `done` of the `count` loops were there already.
  std::function<void(std::int64_t done, std::int64_t count)> on_start = {};
  /// Called after each loop, in the order of completion; one call at a time, from any thread.
  std::function<void(bool failed)> on_done = {};
  /// Receives LoopResult::aside of a loop; one call at a time, from any thread.
  std::function<void(std::int64_t key, std::string aside)> on_aside = {};
  /// Called for each loop that is tried once more; one call at a time, from any thread. May be empty.
  std::function<void(const std::string&)> on_warning = {};
};

/// Runs the loops with these keys that the store lacks, in this order, and puts their results into it. This
/// is the only place where loops run. Threads are those of OpenMP, with a dynamic schedule. Worker processes,
/// for work that must not run in threads or may crash, are forked before the first thread starts. The store
/// has the same bytes however many loops run at once, and in whatever order they end.
///
/// If the surroundings of a loop fail (is_of_surroundings()), for instance because its worker process is
/// killed from outside, a new thread or process runs the loop once more. If they fail again, nothing is
/// stored of the loop, and the run stops.
///
/// When a stop is requested, no more loops are given out, and those in worker processes, which may take
/// minutes, are given up. Throws Interrupted if not all loops are done, with what happened if the
/// surroundings are the reason; otherwise the exception of the first loop that throws in a thread; InputError
/// that a worker process throws; ArchiveError of the store.
void run_missing(ShardStore& store, const std::vector<std::int64_t>& keys, const LoopWork& work);

}  // namespace mpm
