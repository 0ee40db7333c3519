#include "bench/execution/thread_loop.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <omp.h>

namespace mpm {
namespace {

/// Throws std::runtime_error if `threads` threads cannot exist at once: libgomp would end the process.
void require_threads(int threads) {
  std::mutex gate;
  std::unique_lock closed(gate);
  std::vector<std::jthread> others;
  try {
    while (static_cast<int>(others.size()) + 1 < threads)
      others.emplace_back([&gate] { const std::lock_guard wait(gate); });
  } catch (const std::system_error& error) {
    closed.unlock();
    throw std::runtime_error(
        fmt::format("{} of {} threads could be started ({}): use fewer --jobs, or raise the limit",
                    others.size() + 1, threads, error.code().message()));
  }
  closed.unlock();
}

/// Ends the threads that OpenMP keeps for the next loop: a process that forks must have no other thread.
class ReleasedThreads {
 public:
  ReleasedThreads() = default;
  ~ReleasedThreads() { omp_pause_resource_all(omp_pause_hard); }
  ReleasedThreads(const ReleasedThreads&) = delete;
  ReleasedThreads& operator=(const ReleasedThreads&) = delete;
};

}  // namespace

void for_each_in_threads(std::size_t count, int threads,
                         const std::function<void(std::size_t index, std::size_t thread)>& body) {
  std::exception_ptr failure;                     // no exception may leave a thread
  std::atomic<std::size_t> first_failure{count};  // only calls before it can still matter
  require_threads(threads);
  const ReleasedThreads release;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t i = 0; i < count; ++i) {
    if (i > first_failure)
      continue;
    try {
      body(i, static_cast<std::size_t>(omp_get_thread_num()));
    } catch (...) {
#pragma omp critical
      if (i < first_failure) {
        first_failure = i;
        failure = std::current_exception();
      }
    }
  }
  if (failure)
    std::rethrow_exception(failure);
}

}  // namespace mpm
