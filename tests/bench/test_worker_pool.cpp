#include <chrono>
#include <functional>
#include <map>
#include <new>
#include <stdexcept>
#include <string>

#include <catch2/catch.hpp>
#include <signal.h>
#include <unistd.h>

#include "base/system/surroundings.hpp"
#include "bench/execution/worker_pool.hpp"

namespace {

using namespace mpm;

std::map<std::int64_t, TaskResult> run_all(std::int64_t count, int jobs,
                                           const std::function<std::string(std::int64_t)>& work) {
  std::map<std::int64_t, TaskResult> results;
  WorkerPool pool(jobs, [&work](const std::string& request) { return work(std::stoll(request)); });
  std::int64_t next = 0;
  while (next < count || pool.has_busy()) {
    if (next < count && pool.has_idle()) {
      pool.start(next, std::to_string(next));
      ++next;
      continue;
    }
    TaskResult result = pool.wait();
    results.emplace(result.id, std::move(result));
  }
  return results;
}

TEST_CASE("worker pool: every task is answered once, in other processes") {
  for (const int jobs : {1, 2, 5, 50}) {
    const auto results = run_all(20, jobs, [](std::int64_t i) { return std::to_string(i * i); });
    REQUIRE(results.size() == 20);
    for (const auto& [index, result] : results) {
      CHECK(result.end == TaskEnd::answered);
      CHECK(result.bytes == std::to_string(index * index));
    }
  }
  const auto pid = run_all(1, 1, [](std::int64_t) { return std::to_string(::getpid()); });
  CHECK(pid.at(0).bytes != std::to_string(::getpid()));
}

TEST_CASE("worker pool: a killed worker costs its task alone") {
  const auto results = run_all(12, 2, [](std::int64_t i) {
    if (i == 3)
      ::kill(::getpid(), SIGKILL);
    if (i == 7)
      ::_exit(9);
    if (i == 9)
      throw std::runtime_error("not today");
    if (i == 10)
      ::raise(SIGSEGV);
    if (i == 4)
      throw std::bad_alloc();
    if (i == 5)
      throw SurroundingsFailure("nobody there");
    return std::string(100000, static_cast<char>('a' + i));  // longer than a socket buffer
  });
  REQUIRE(results.size() == 12);
  for (const auto& [index, result] : results)
    CHECK(result.end == (index >= 3 && index <= 5                  ? TaskEnd::surroundings
                         : index == 7 || index == 9 || index == 10 ? TaskEnd::crashed
                                                                   : TaskEnd::answered));
  CHECK(results.at(3).bytes.find("signal 9") != std::string::npos);
  CHECK(results.at(7).bytes.find("code 9") != std::string::npos);
  CHECK(results.at(9).bytes == "not today");
  CHECK(results.at(4).bytes == "not enough memory");
  CHECK(results.at(5).bytes == "nobody there");
  CHECK(results.at(11).bytes == std::string(100000, 'l'));
}

TEST_CASE("worker pool: long requests arrive whole") {
  const std::string request(3000000, 'x');  // longer than a socket buffer
  WorkerPool pool(1, [](const std::string& bytes) { return std::to_string(bytes.size()); });
  pool.start(7, request);
  const TaskResult result = pool.wait();
  CHECK(result.id == 7);
  CHECK(result.bytes == "3000000");
}

TEST_CASE("worker pool: its end ends a worker that is at work") {
  const auto start = std::chrono::steady_clock::now();
  {
    WorkerPool pool(1, [](const std::string&) {
      ::sleep(60);
      return std::string();
    });
    pool.start(0, "");
    CHECK(pool.has_busy());
    CHECK_FALSE(pool.has_idle());
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(30));
}

}  // namespace
