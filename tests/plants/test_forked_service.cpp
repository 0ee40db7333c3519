#include <csignal>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "plants/forked_service.hpp"

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

}  // namespace
}  // namespace mpm
