#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/fork_server.hpp"
#include "base/system/forked_service.hpp"
#include "base/system/surroundings.hpp"

namespace mpm {
namespace {

using Catch::Contains;

constexpr double kPatience = 30.0;  // s: far more than any answer here takes

std::vector<double> sum_of(const std::vector<double>& numbers) {
  return {std::accumulate(numbers.begin(), numbers.end(), 0.0)};
}

TEST_CASE("a forked service answers, again and again, in another process") {
  ForkedService service([](const auto& numbers) { return sum_of(numbers); }, kPatience);
  CHECK(service.ask({1, 2, 3.5}) == std::vector<double>{6.5});
  CHECK(service.ask({}) == std::vector<double>{0});
  ForkedService other([](const auto&) { return std::vector<double>{static_cast<double>(::getpid())}; },
                      kPatience);
  CHECK(other.ask({}).front() != static_cast<double>(::getpid()));
  CHECK(other.ask({}) == other.ask({}));
  const std::vector<double> many(100000, 0.5);  // more than a socket holds
  CHECK(service.ask(many) == std::vector<double>{50000});
}

TEST_CASE("what a forked service throws reaches its user, and it goes on") {
  ForkedService service(
      [](const std::vector<double>& numbers) {
        if (numbers.empty())
          throw std::runtime_error("nothing to add");
        return sum_of(numbers);
      },
      kPatience);
  CHECK_THROWS_WITH(service.ask({}), "nothing to add");
  CHECK(service.ask({2, 2}) == std::vector<double>{4});
}

TEST_CASE("the end of the process of a forked service is told, and the next call fails as well") {
  ForkedService service(
      [](const std::vector<double>& numbers) {
        if (numbers.front() == 0)
          std::raise(SIGSEGV);
        std::_Exit(7);
        return std::vector<double>();
      },
      kPatience);
  CHECK_THROWS_WITH(service.ask({0}), Contains("ended by signal 11"));
  CHECK_THROWS_AS(service.ask({0}), ForeignFailure);
  ForkedService other([](const std::vector<double>&) -> std::vector<double> { std::_Exit(7); }, kPatience);
  CHECK_THROWS_WITH(other.ask({1}), "its process ended with code 7");
}

TEST_CASE("a forked service that is killed from outside, or has no memory, was not asked") {
  const auto serve = [](const std::vector<double>& numbers) -> std::vector<double> {
    if (numbers.front() == 0)
      throw std::bad_alloc();
    std::raise(static_cast<int>(numbers.front()));
    return numbers;
  };
  const ForkServer server([&serve](const std::vector<double>&) { return serve; });
  for (const int signal : {0, SIGHUP, SIGKILL, SIGTERM}) {
    ForkedService service(serve, kPatience);
    CHECK_THROWS_AS(service.ask({1.0 * signal}), SurroundingsFailure);
    ServedProcess served(server, {}, kPatience);
    CHECK_THROWS_AS(served.ask({1.0 * signal}), SurroundingsFailure);
  }
  ServedProcess crashes(server, {}, kPatience);
  CHECK_THROWS_AS(crashes.ask({1.0 * SIGABRT}), ForeignFailure);
  ServedProcess memory(server, {}, kPatience);
  CHECK_THROWS_WITH(memory.ask({0}), "not enough memory");
}

TEST_CASE("services of a server: whoever waits for one, or makes them, is none of it", "[fork-server]") {
  const ForkServer server([](const std::vector<double>&) {
    return [](const std::vector<double>& numbers) -> std::vector<double> {
      const pid_t mediator = ::getppid();
      std::ifstream status("/proc/" + std::to_string(mediator) + "/stat");
      std::string word, maker;
      status >> word >> word >> word >> maker;
      ::kill(numbers.front() == 0 ? mediator : std::stoi(maker), SIGKILL);
      for (;;)
        ::pause();
    };
  });
  ServedProcess first(server, {}, kPatience);
  CHECK_THROWS_AS(first.ask({0}), SurroundingsFailure);
  ServedProcess second(server, {}, 1.0);
  CHECK_THROWS(second.ask({1}));  // its mediator lives, and ends it in time
  // Without the process that makes them there is none, or no answer, as the end of that process is seen.
  CHECK_THROWS_AS(ServedProcess(server, {}, kPatience).ask({0}), SurroundingsFailure);
}

TEST_CASE("an answer that does not come is given up") {
  ForkedService service(
      [](const std::vector<double>&) -> std::vector<double> {
        for (;;)
          ::pause();
      },
      0.05);
  CHECK_THROWS_WITH(service.ask({}), "no answer within 0.05 s");
  CHECK_THROWS_AS(service.ask({}), ForeignFailure);
}

TEST_CASE("what a service sends is not trusted, and a closed connection is not waited for") {
  constexpr int kItsSocket = 3;
  const auto sends = [](std::int64_t failed, std::int64_t size) {
    return [=](const std::vector<double>&) -> std::vector<double> {
      const std::array<std::int64_t, 2> header{failed, size};
      static_cast<void>(::write(kItsSocket, header.data(), sizeof header));
      for (;;)
        ::pause();
    };
  };
  for (const std::int64_t size : {std::int64_t{-8}, std::int64_t{1} << 60, std::int64_t{3}}) {
    ForkedService service(sends(0, size), kPatience);
    CHECK_THROWS_WITH(service.ask({}), Contains(" bytes; allowed: 0 to "));
  }
  ForkedService boasts(sends(1, 5'000'000), kPatience);
  CHECK_THROWS_WITH(boasts.ask({}), Contains("a message of 5000000 bytes"));
  ForkedService closes(
      [](const std::vector<double>&) -> std::vector<double> {
        ::close(kItsSocket);
        for (;;)
          ::pause();
      },
      kPatience);
  CHECK_THROWS_WITH(closes.ask({}), "its process closed the connection to this one");
  ForkedService wordy(
      [](const std::vector<double>&) -> std::vector<double> {
        throw std::runtime_error(std::string(5'000'000, 'x') + "\n");
      },
      kPatience);
  CHECK_THROWS_WITH(wordy.ask({}), std::string(1000, 'x') + "...");
}

TEST_CASE("a forked service keeps what it prints and what it does to memory to itself") {
  int mine = 1;
  ForkedService service(
      [&mine](const std::vector<double>&) {
        mine = 2;
        return std::vector<double>{static_cast<double>(::write(STDOUT_FILENO, "x", 1)),
                                   static_cast<double>(mine)};
      },
      kPatience);
  CHECK(service.ask({}) == std::vector<double>{1, 2});
  CHECK(mine == 1);
}

TEST_CASE("services of a server: in other threads too, and whatever locks they hold", "[fork-server]") {
  std::mutex mutex;
  const ForkServer server([&mutex](const std::vector<double>& setting) {
    return [&mutex, setting](const std::vector<double>& numbers) {
      const std::lock_guard lock(mutex);  // of the copy: nobody holds it there
      return std::vector<double>{setting.at(0) * sum_of(numbers).front()};
    };
  });
  const std::lock_guard held(mutex);
  std::vector<double> answers(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < answers.size(); ++i)
    threads.emplace_back([&, i] {
      ServedProcess service(server, {static_cast<double>(i)}, kPatience);
      answers[i] = service.ask({1, 2}).front() + service.ask({4}).front();
    });
  for (std::thread& thread : threads)
    thread.join();
  for (std::size_t i = 0; i < answers.size(); ++i)
    CHECK(answers[i] == 7.0 * static_cast<double>(i));
}

TEST_CASE("services of a server: their ends and failures are told, and the next one is another",
          "[fork-server]") {
  const ForkServer server([](const std::vector<double>&) {
    return [](const std::vector<double>& numbers) -> std::vector<double> {
      if (numbers.empty())
        throw std::runtime_error("nothing to add");
      if (numbers.front() == 0)
        std::raise(SIGSEGV);
      if (numbers.front() == 1)
        std::_Exit(7);
      if (numbers.front() == 2)
        for (;;)
          ::pause();
      return sum_of(numbers);
    };
  });
  ServedProcess service(server, {}, kPatience);
  CHECK_THROWS_WITH(service.ask({}), "nothing to add");
  CHECK_THROWS_WITH(service.ask({0}), Contains("ended by signal 11"));
  CHECK_THROWS_AS(service.ask({3}), ForeignFailure);
  ServedProcess other(server, {}, kPatience);
  CHECK_THROWS_WITH(other.ask({1}), "its process ended with code 7");
  ServedProcess slow(server, {}, 0.05);
  CHECK_THROWS_WITH(slow.ask({2}), "no answer within 0.05 s");
  ServedProcess last(server, {}, kPatience);
  CHECK(last.ask({3, 4}) == std::vector<double>{7});
}

TEST_CASE("services of a server: a process that was forked later has them too", "[fork-server]") {
  const ForkServer server([](const std::vector<double>&) { return sum_of; });
  const pid_t child = ::fork();
  if (child == 0) {
    ServedProcess service(server, {}, kPatience);
    ::_exit(service.ask({1, 2}) == std::vector<double>{3} ? 0 : 1);
  }
  ServedProcess service(server, {}, kPatience);
  CHECK(service.ask({2, 3}) == std::vector<double>{5});
  int status = 1;
  ::waitpid(child, &status, 0);
  CHECK(status == 0);
}

}  // namespace
}  // namespace mpm
