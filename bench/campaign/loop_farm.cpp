#include "bench/campaign/loop_farm.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/system/surroundings.hpp"
#include "bench/execution/second_try.hpp"
#include "bench/execution/thread_loop.hpp"
#include "bench/execution/worker_pool.hpp"
#include "results/files/byte_stream.hpp"

namespace mpm {
namespace {

/// How long threads run before worker processes finish what the threads have left: much longer than an
/// experiment, so that the wait for the last one is short, and no longer than the work that a killed run may
/// lose.
constexpr std::chrono::seconds kRound(2);
constexpr std::int64_t kMostInRound = 100'000;
/// The most loops of a round that one of `threads` threads takes together.
std::size_t most_together(std::size_t count, int threads) {
  constexpr std::size_t kTurns = 4;  // turns of each thread, so that none waits long for the last one
  return std::max<std::size_t>(1, count / (kTurns * static_cast<std::size_t>(threads)));
}

/// How many loops may wait for worker processes: each may hold a record.
constexpr std::size_t kMostWaiting = 1000;

/// A loop for a worker process.
struct BegunLoop {
  std::int64_t key = 0;
  std::string begun = {};
  bool again = false;      ///< tried again, after its worker process crashed
  bool disturbed = false;  ///< its surroundings failed once
};

std::string answer(const LoopWork& work, const std::string& request) {
  ByteReader reader(request);
  BegunLoop task;
  transfer_all(reader, task.key, task.begun);
  LoopResult result;
  std::string refused;
  try {
    result = work.process(task.key, task.begun);
  } catch (const InputError& error) {
    refused = error.what();
  }
  ByteWriter writer;
  transfer_all(writer, std::as_const(refused), std::as_const(result.failed), std::as_const(result.bytes),
               std::as_const(result.aside));
  return writer.take();
}

class LoopFarm {
 public:
  LoopFarm(ShardStore& store, const std::vector<std::int64_t>& keys, const LoopWork& work)
      : store_(store),
        work_(work),
        missing_(store.missing(keys)),
        count_(std::ssize(keys)),
        done_(count_ - std::ssize(missing_)) {}

  void run() {
    if (work_.on_start)
      work_.on_start(done_, count_);
    try {
      run_all();
    } catch (const std::exception& error) {
      if (!is_of_surroundings(error))
        throw;
      store_.flush();
      throw Interrupted(done_, count_, work_.what, what_happened(error));
    }
    store_.flush();
    if (done_ < count_)
      throw Interrupted(done_, count_, work_.what);
  }

 private:
  void run_all() {
    if (work_.process && !missing_.empty())
      pool_.emplace(work_.thread ? work_.jobs : static_cast<int>(std::min<std::int64_t>(work_.jobs, left())),
                    [this](const std::string& request) { return answer(work_, request); });
    if (work_.thread)
      run_threads();
    else if (pool_)
      work_off([this] { return left() > 0 ? std::optional(BegunLoop{missing_[next_++]}) : std::nullopt; });
  }

  std::int64_t left() const { return std::ssize(missing_) - static_cast<std::int64_t>(next_); }

  void run_threads() {
    std::vector<LoopWork::Thread> threads;
    while (left() > 0 && std::ssize(threads) < work_.jobs)
      threads.push_back(work_.thread());
    while (left() > 0 && !requested(work_.stop)) {
      run_round(threads, static_cast<std::size_t>(pool_ ? std::min(kMostInRound, left()) : left()));
      if (pool_)
        work_off([] { return std::optional<BegunLoop>(); });
      count_waiting_ = waiting_.size();
    }
  }

  /// Runs the next `count` loops in threads; if there are worker processes, only as many as a round has time
  /// for.
  void run_round(std::vector<LoopWork::Thread>& threads, std::size_t count) {
    using RoundClock = std::chrono::steady_clock;
    const RoundClock::time_point end = pool_ ? RoundClock::now() + kRound : RoundClock::time_point::max();
    std::vector<char> is_left_out(count, 0);
    const auto run_one = [&](std::size_t i, std::size_t thread) {
      if (requested(work_.stop) || RoundClock::now() >= end || count_waiting_ >= kMostWaiting) {
        is_left_out[i] = 1;
        return;
      }
      const std::int64_t key = missing_[next_ + i];
      LoopResult result = second_try([&] { return threads[thread](key); },
                                     [&](const std::exception& error) {
                                       const std::lock_guard one_at_a_time(delivery_);
                                       tell_of_second_try(what_happened(error));
                                       threads[thread] = work_.thread();
                                     });
      const std::lock_guard one_at_a_time(delivery_);
      if (result.unfinished)
        waiting_.push_back({key, std::move(result.bytes)});
      else
        deliver(key, std::move(result));
      count_waiting_ = waiting_.size();
    };
    const std::vector<std::size_t> ends = ends_of_groups(count);
    for_each_in_threads(ends.size(), work_.jobs, [&](std::size_t group, std::size_t thread) {
      for (std::size_t i = group == 0 ? 0 : ends[group - 1]; i < ends[group]; ++i)
        run_one(i, thread);
    });
    std::vector<std::int64_t> left_out;
    for (std::size_t i = 0; i < count; ++i)
      if (is_left_out[i] != 0)
        left_out.push_back(missing_[next_ + i]);
    next_ += count - left_out.size();
    std::copy(left_out.begin(), left_out.end(), missing_.begin() + static_cast<std::ptrdiff_t>(next_));
  }

  /// The ends of the groups, among the next `count` loops, that a thread takes together.
  std::vector<std::size_t> ends_of_groups(std::size_t count) const {
    const std::size_t most = work_.group ? most_together(count, work_.jobs) : 1;
    std::vector<std::size_t> ends;
    for (std::size_t i = 0, first = 0; i < count; ++i)
      if (i + 1 == count || i + 1 - first == most ||
          work_.group(missing_[next_ + i]) != work_.group(missing_[next_ + i + 1])) {
        ends.push_back(i + 1);
        first = i + 1;
      }
    return ends;
  }

  /// Runs the waiting loops, and those that `more` gives, in worker processes until a stop is requested.
  template <class More>
  void work_off(const More& more) {
    std::map<std::int64_t, BegunLoop> under_way;
    while (!requested(work_.stop)) {
      if (std::optional<BegunLoop> task = pool_->has_idle() ? next_task(more) : std::nullopt) {
        const std::int64_t key = task->key;
        ByteWriter writer;
        transfer_all(writer, key, std::as_const(task->begun));
        pool_->start(key, writer.take());
        under_way.insert_or_assign(key, *std::move(task));
      } else if (!pool_->has_busy()) {
        return;
      } else if (const std::optional<TaskResult> result = next_finding(*pool_, work_.stop)) {
        take(*result, std::move(under_way.extract(result->id).mapped()));
      }
    }
  }

  template <class More>
  std::optional<BegunLoop> next_task(const More& more) {
    if (waiting_.empty())
      return more();
    std::optional<BegunLoop> task = std::move(waiting_.front());
    waiting_.pop_front();
    return task;
  }

  void take(const TaskResult& result, BegunLoop task) {
    if (result.end == TaskEnd::surroundings) {
      if (task.disturbed)
        throw SurroundingsFailure(result.bytes);
      tell_of_second_try(result.bytes);
      task.disturbed = true;
      waiting_.push_front(std::move(task));
    } else if (result.end == TaskEnd::answered) {
      ByteReader reader(result.bytes);
      LoopResult done;
      std::string refused;
      transfer_all(reader, refused, done.failed, done.bytes, done.aside);
      if (!refused.empty())
        throw InputError(refused);
      deliver(task.key, std::move(done));
    } else if (std::optional<LoopResult> lost = work_.lost(task.key, task.begun, result.bytes, task.again)) {
      deliver(task.key, *std::move(lost));
    } else {
      task.again = true;
      waiting_.push_front(std::move(task));
    }
  }

  void tell_of_second_try(const std::string& why) const {
    if (work_.on_warning)
      work_.on_warning(fmt::format("{}; its work is tried once more", why));
  }

  void deliver(std::int64_t key, LoopResult result) {
    ++done_;
    if (work_.on_done)
      work_.on_done(result.failed);
    store_.add(key, std::move(result.bytes));
    if (work_.on_aside && !result.aside.empty())
      work_.on_aside(key, std::move(result.aside));
    if (requested(work_.stop))
      store_.flush();  // the other loops may not end in the time that is left
  }

  ShardStore& store_;
  const LoopWork& work_;
  std::vector<std::int64_t> missing_;
  std::int64_t count_, done_;
  std::size_t next_ = 0;  ///< place of the next loop among the missing ones
  std::mutex delivery_;
  std::deque<BegunLoop> waiting_;  ///< for worker processes
  std::atomic<std::size_t> count_waiting_ = 0;
  std::optional<WorkerPool> pool_;
};

}  // namespace

void run_missing(ShardStore& store, const std::vector<std::int64_t>& keys, const LoopWork& work) {
  LoopFarm(store, keys, work).run();
}

}  // namespace mpm
