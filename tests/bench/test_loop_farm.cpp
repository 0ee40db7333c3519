#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "bench/campaign/loop_farm.hpp"

namespace {

using namespace mpm;

/// Runs 40 loops by two threads, and says which of them ran those of each group.
std::map<std::int64_t, std::set<int>> threads_of_groups(std::int64_t loops_of_group) {
  std::vector<std::int64_t> keys(40);
  std::iota(keys.begin(), keys.end(), 0);
  std::map<std::int64_t, std::set<int>> threads;
  std::mutex mutex;
  std::atomic<int> count = 0;
  const auto group = [loops_of_group](std::int64_t key) { return key / loops_of_group; };
  ShardStore store(ShardIdentity{});
  run_missing(store, keys,
              {.jobs = 2,
               .thread =
                   [&] {
                     return [&, number = count++](std::int64_t key) -> LoopResult {
                       const std::lock_guard one_at_a_time(mutex);
                       threads[group(key)].insert(number);
                       return {.bytes = std::to_string(key)};
                     };
                   },
               .group = group});
  CHECK(store.missing(keys).empty());
  return threads;
}

TEST_CASE("loop farm: one thread takes the loops of a group") {
  const auto threads = threads_of_groups(5);
  CHECK(threads.size() == 8);
  CHECK(std::all_of(threads.begin(), threads.end(),
                    [](const auto& group) { return group.second.size() == 1; }));
}

TEST_CASE("loop farm: a group of all loops leaves no thread idle") {
  ShardStore store(ShardIdentity{});
  std::vector<std::int64_t> keys(40);
  std::iota(keys.begin(), keys.end(), 0);
  std::atomic<int> count = 0;
  std::vector<std::atomic<int>> begun(2);
  // Each thread waits in its first loop for the first loop of the other one.
  run_missing(store, keys,
              {.jobs = 2,
               .thread =
                   [&] {
                     return [&, number = static_cast<std::size_t>(count++)](std::int64_t) -> LoopResult {
                       begun[number] = 1;
                       begun[number].notify_all();
                       begun[1 - number].wait(0);
                       return {.bytes = "done"};
                     };
                   },
               .group = [](std::int64_t) { return 0; }});
  CHECK(store.missing(keys).empty());
}

}  // namespace
