#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "base/derived_values.hpp"
#include "base/system/thread_clock.hpp"

namespace mpm {
namespace {

/// Makes numbers, and counts them.
struct Maker {
  int made = 0;

  std::shared_ptr<const int> ask(const DerivedValues& values, const std::string& key = "number") {
    return values.of<const int>(key, [&] { return std::make_shared<int>(++made); });
  }
};

DerivedValues kept(PaidBy paid = PaidBy::first) {
  DerivedValues values;
  values.keep(paid);
  return values;
}

}  // namespace

TEST_CASE("a derived value is made once for its type and key, where values are kept", "[derived_values]") {
  const DerivedValues values = kept();
  Maker maker;
  CHECK(*maker.ask(values) == 1);
  CHECK(*maker.ask(values) == 1);
  CHECK(*maker.ask(values, "another number") == 2);
  CHECK(*values.of<const double>("number", [] { return std::make_shared<double>(0.5); }) == 0.5);
  CHECK(*maker.ask(values) == 1);
  // One that is made from another one.
  const auto twice = [&] { return std::make_shared<double>(2.0 * *maker.ask(values)); };
  CHECK(*values.of<const double>("twice", twice) == 2.0);
  CHECK(maker.made == 2);
}

TEST_CASE("nothing is kept before keep(), nor in a copy, which may be changed", "[derived_values]") {
  const DerivedValues none;
  Maker maker;
  maker.ask(none);
  maker.ask(none);
  CHECK(maker.made == 2);

  DerivedValues values = kept();
  maker.ask(values);
  const DerivedValues copy = values;
  maker.ask(copy);
  maker.ask(copy);
  CHECK(maker.made == 5);
  const DerivedValues moved = std::move(values);
  CHECK(*maker.ask(moved) == 3);
  DerivedValues assigned = kept();
  maker.ask(assigned);
  assigned = copy;
  maker.ask(assigned);
  maker.ask(assigned);
  CHECK(maker.made == 8);
}

TEST_CASE("a derived value that cannot be made is an error for each who asks", "[derived_values]") {
  const DerivedValues values = kept();
  int tried = 0;
  const auto ask = [&] {
    return *values.of<const int>("number", [&]() -> std::shared_ptr<int> {
      if (++tried < 3)
        throw std::runtime_error("not yet");
      return std::make_shared<int>(tried);
    });
  };
  CHECK_THROWS_WITH(ask(), "not yet");
  CHECK_THROWS_WITH(ask(), "not yet");
  CHECK(ask() == 3);
  CHECK(ask() == 3);
}

TEST_CASE("the processor time of a value is that of the first who asks, or of each", "[derived_values]") {
  constexpr double kSeconds = 1000.0;
  const auto slow = [] {
    count_for_thread(kSeconds);
    return std::make_shared<int>(1);
  };
  for (const PaidBy paid : {PaidBy::first, PaidBy::each}) {
    const DerivedValues values = kept(paid);
    const auto seconds = [&] {
      const double start = thread_seconds();
      values.of<const int>("slow", slow);
      return thread_seconds() - start;
    };
    CHECK(seconds() == Approx(kSeconds).margin(1.0));
    CHECK(seconds() == Approx(paid == PaidBy::each ? kSeconds : 0.0).margin(1.0));
  }
}

TEST_CASE("threads that ask at once get one value", "[derived_values]") {
  const DerivedValues values = kept();
  Maker maker;
  std::vector<std::shared_ptr<const int>> found(8);
  std::vector<std::thread> threads;
  for (auto& each : found)
    threads.emplace_back([&] { each = maker.ask(values); });
  for (std::thread& thread : threads)
    thread.join();
  for (const auto& each : found)
    CHECK(each == found.front());
  CHECK(maker.made == 1);
}

}  // namespace mpm
