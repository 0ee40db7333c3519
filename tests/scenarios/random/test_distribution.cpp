#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/distribution.hpp"
#include "tests/scenarios/goodness_of_fit.hpp"

namespace {

using mpm::Distribution;
using mpm::RandomStream;
using mpm::StreamId;

std::vector<double> draw(const Distribution& distribution, int count) {
  RandomStream stream(21, 0, StreamId::disturbance_draw);
  std::vector<double> sample;
  for (int i = 0; i < count; ++i) {
    sample.push_back(distribution.sample(stream));
  }
  return sample;
}

template <class Function>
void check_distribution(const Distribution& distribution, Function distribution_function) {
  const auto sample = draw(distribution, 20000);
  for (const double x : sample) {
    REQUIRE(x >= distribution.minimum());
    REQUIRE(x <= distribution.maximum());
  }
  CHECK(mpm::testing::kolmogorov_distance(sample, distribution_function) <
        mpm::testing::kolmogorov_critical(sample.size()));
}

}  // namespace

TEST_CASE("samples follow the distribution function") {
  check_distribution(Distribution::uniform(-3.0, 5.0), [](double x) { return (x + 3.0) / 8.0; });
  check_distribution(Distribution::log_uniform(0.1, 10.0),
                     [](double x) { return std::log(x / 0.1) / std::log(100.0); });
  check_distribution(Distribution::normal(2.0, 0.5),
                     [](double x) { return 0.5 * std::erfc(-(x - 2.0) / (0.5 * std::sqrt(2.0))); });
}

TEST_CASE("a constant is always its value") {
  for (const double x : draw(Distribution::constant(1.25), 10)) {
    CHECK(x == 1.25);
  }
}

TEST_CASE("a log-uniform draw over hundreds of decades stays finite and inside") {
  const auto distribution = Distribution::log_uniform(1e-300, 1e300);
  int below_one = 0;
  for (const double x : draw(distribution, 10000)) {
    REQUIRE((x >= 1e-300 && x <= 1e300));
    below_one += x < 1.0 ? 1 : 0;
  }
  CHECK(std::abs(below_one - 5000) < 4.0 * 50.0);  // four standard deviations of a fair coin
}

TEST_CASE("the support") {
  CHECK(Distribution::constant(2.0).minimum() == 2.0);
  CHECK(Distribution::constant(2.0).maximum() == 2.0);
  CHECK(Distribution::uniform(-1.0, 3.0).minimum() == -1.0);
  CHECK(Distribution::uniform(-1.0, 3.0).maximum() == 3.0);
  CHECK(Distribution::log_uniform(0.5, 3.0).minimum() == 0.5);
  CHECK(Distribution::log_uniform(0.5, 3.0).maximum() == 3.0);
  CHECK(Distribution::normal(0.0, 1.0).minimum() == -mpm::kInfinity);
  CHECK(Distribution::normal(0.0, 1.0).maximum() == mpm::kInfinity);
}

TEST_CASE("every kind takes one value from the stream") {
  for (const auto& distribution : {Distribution::constant(1.0), Distribution::uniform(0.0, 1.0),
                                   Distribution::log_uniform(1.0, 2.0), Distribution::normal(0.0, 1.0)}) {
    RandomStream stream(1, 0, StreamId::mismatch);
    distribution.sample(stream);
    CHECK(stream.position() == 1);
  }
}

TEST_CASE("distributions compare by value") {
  CHECK(Distribution::uniform(0.0, 1.0) == Distribution::uniform(0.0, 1.0));
  CHECK_FALSE(Distribution::uniform(0.0, 1.0) == Distribution::uniform(0.0, 2.0));
  CHECK_FALSE(Distribution::uniform(1.0, 2.0) == Distribution::log_uniform(1.0, 2.0));
}

TEST_CASE("distributions refuse parameters that describe none") {
  using mpm::InputError;
  CHECK_THROWS_AS(Distribution::constant(mpm::kNaN), InputError);
  CHECK_THROWS_AS(Distribution::constant(mpm::kInfinity), InputError);
  CHECK_THROWS_AS(Distribution::uniform(1.0, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::uniform(2.0, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::uniform(mpm::kNaN, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::uniform(0.0, mpm::kInfinity), InputError);
  CHECK_THROWS_AS(Distribution::uniform(-1e308, 1e308), InputError);
  CHECK_THROWS_AS(Distribution::log_uniform(0.0, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::log_uniform(-1.0, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::log_uniform(2.0, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::log_uniform(1.0, mpm::kInfinity), InputError);
  CHECK_THROWS_AS(Distribution::normal(mpm::kNaN, 1.0), InputError);
  CHECK_THROWS_AS(Distribution::normal(0.0, 0.0), InputError);
  CHECK_THROWS_AS(Distribution::normal(0.0, -1.0), InputError);
  CHECK_THROWS_AS(Distribution::normal(0.0, mpm::kNaN), InputError);
}

TEST_CASE("a refusal names the quantity, what was found and what is allowed") {
  try {
    Distribution::log_uniform(3.0, 0.1);
    FAIL("not refused");
  } catch (const mpm::InputError& error) {
    CHECK(std::string(error.what()) ==
          "ends of a log-uniform distribution: found [3, 0.1]; allowed: 0 < low < high, both finite");
  }
}
