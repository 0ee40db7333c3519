#include "bench/execution/thread_loop.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <future>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

namespace mpm {

void in_threads(int threads, const std::function<void(std::size_t thread)>& body) {
  std::promise<bool> complete;
  const std::shared_future<bool> all_are_there(complete.get_future());
  std::vector<std::jthread> others;
  try {
    for (std::size_t thread = 1; thread < static_cast<std::size_t>(threads); ++thread)
      others.emplace_back([&, thread] {
        if (all_are_there.get())
          body(thread);
      });
  } catch (const std::system_error& error) {
    complete.set_value(false);
    throw std::runtime_error(
        fmt::format("{} of {} threads could be made ({}): fewer --jobs, or a higher limit", others.size() + 1,
                    threads, error.code().message()));
  }
  complete.set_value(true);
  body(0);
}

void for_each_in_threads(std::size_t count, int threads,
                         const std::function<void(std::size_t index, std::size_t thread)>& body) {
  std::vector<std::exception_ptr> failures(count);  // none may leave a thread
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> first_failure{count};  // only calls before it can still matter
  in_threads(threads, [&](std::size_t thread) {
    for (std::size_t i = next++; i < std::min(count, first_failure.load()); i = next++)
      try {
        body(i, thread);
      } catch (...) {
        failures[i] = std::current_exception();
        std::size_t first = first_failure;
        while (i < first && !first_failure.compare_exchange_weak(first, i)) {
        }
      }
  });
  if (first_failure < count)
    std::rethrow_exception(failures[first_failure]);
}

}  // namespace mpm
