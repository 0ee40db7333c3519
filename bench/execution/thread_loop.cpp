#include "bench/execution/thread_loop.hpp"

#include <atomic>
#include <exception>
#include <vector>

#include <omp.h>

namespace mpm {

void for_each_in_threads(std::size_t count, int threads,
                         const std::function<void(std::size_t index, std::size_t thread)>& body) {
  std::vector<std::exception_ptr> failures(count);  // none may leave a thread
  std::atomic<std::size_t> first_failure{count};    // only calls before it can still matter
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t i = 0; i < count; ++i) {
    if (i > first_failure)
      continue;
    try {
      body(i, static_cast<std::size_t>(omp_get_thread_num()));
    } catch (...) {
      failures[i] = std::current_exception();
      std::size_t first = first_failure;
      while (i < first && !first_failure.compare_exchange_weak(first, i)) {
      }
    }
  }
  if (first_failure < count)
    std::rethrow_exception(failures[first_failure]);
}

}  // namespace mpm
