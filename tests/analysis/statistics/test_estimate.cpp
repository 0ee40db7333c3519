#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "analysis/statistics/estimate.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {

TEST_CASE("median: the value in the middle, with order statistics as its interval") {
  // Of B(9, 1/2): P(< 2) = 10/512 <= 0.025 < P(< 3) = 46/512, so the second value from each end.
  const Estimate odd = median_estimate({9, 1, 8, 2, 7, 3, 6, 4, 5}, 0.95);
  CHECK(odd.value == 5.0);
  CHECK(odd.interval.lower == 2.0);
  CHECK(odd.interval.upper == 8.0);
  CHECK(odd.count == 9);
  CHECK(median_estimate({1, 2, 4, 100}, 0.95).value == 3.0);
  CHECK(std::isnan(median_estimate({1, 2, 3, 4, 5}, 0.95).interval.lower));
  CHECK_FALSE(std::isnan(median_estimate({1, 2, 3, 4, 5, 6}, 0.95).interval.lower));
  CHECK(std::isnan(median_estimate({}, 0.95).value));
  CHECK_THROWS_AS(median_estimate({1}, 1.0), InputError);
}

TEST_CASE("median: of delays that did not end it is known as long as half of them did") {
  const double never = std::numeric_limits<double>::infinity();
  CHECK(median_estimate({10, never, 20, 30, never}, 0.95).value == 30.0);
  CHECK(median_estimate({10, never, never}, 0.95).value == never);
}

TEST_CASE("median: its interval holds the true median about as often as it says") {
  RandomStream stream(11, 0, StreamId::measurement_noise);
  int held = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    std::vector<double> values(25);
    for (double& value : values)
      value = std::exp(stream.normal());  // median 1
    held += median_estimate(values, 0.9).interval.contains(1.0) ? 1 : 0;
  }
  // The exact coverage with 25 values is 1 - 2 P(B(25, 1/2) < 8) = 0.957.
  CHECK(std::abs(held / double{kSamples} - 0.957) < 4 * std::sqrt(0.957 * 0.043 / kSamples));
}

TEST_CASE("rate of events: Garwood's interval") {
  const Estimate none = poisson_rate(0, 2.0, 0.95);
  CHECK(none.value == 0.0);
  CHECK(none.interval.lower == 0.0);
  CHECK(none.interval.upper == Approx(-std::log(0.025) / 2.0));  // P(no event) = exp(-rate 2) = 0.025
  const Estimate ten = poisson_rate(10, 1.0, 0.95);
  CHECK(ten.interval.lower == Approx(4.7954).epsilon(1e-4));  // Garwood (1936), table
  CHECK(ten.interval.upper == Approx(18.3904).epsilon(1e-4));
  CHECK(std::isnan(poisson_rate(0, 0.0, 0.95).value));
  CHECK_THROWS_AS(poisson_rate(-1, 1.0, 0.95), InputError);
}

}  // namespace mpm
