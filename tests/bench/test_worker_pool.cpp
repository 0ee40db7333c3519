#include <map>
#include <stdexcept>

#include <catch2/catch.hpp>
#include <signal.h>
#include <unistd.h>

#include "bench/worker_pool.hpp"

namespace {

using namespace mpm;

std::map<std::int64_t, TaskResult> run_all(std::int64_t count, int jobs,
                                           const std::function<std::string(std::int64_t)>& work) {
  std::map<std::int64_t, TaskResult> results;
  run_in_workers(count, jobs, work,
                 [&](TaskResult result) { results.emplace(result.index, std::move(result)); });
  return results;
}

TEST_CASE("worker pool: every task is answered once, in other processes") {
  for (const int jobs : {1, 2, 5, 50}) {
    const auto results = run_all(20, jobs, [](std::int64_t i) { return std::to_string(i * i); });
    REQUIRE(results.size() == 20);
    for (const auto& [index, result] : results) {
      CHECK_FALSE(result.crashed);
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
    return std::string(100000, static_cast<char>('a' + i));  // longer than a socket buffer
  });
  REQUIRE(results.size() == 12);
  for (const auto& [index, result] : results)
    CHECK(result.crashed == (index == 3 || index == 7 || index == 9));
  CHECK(results.at(3).bytes.find("signal 9") != std::string::npos);
  CHECK(results.at(7).bytes.find("code 9") != std::string::npos);
  CHECK(results.at(9).bytes == "not today");
  CHECK(results.at(11).bytes == std::string(100000, 'l'));
}

TEST_CASE("worker pool: an exception in the caller ends the workers and goes on") {
  CHECK_THROWS_AS(run_in_workers(
                      5, 2, [](std::int64_t) { return std::string(); },
                      [](TaskResult) { throw std::logic_error("stop"); }),
                  std::logic_error);
}

}  // namespace
