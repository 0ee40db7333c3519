#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/quantile.hpp"
#include "base/error.hpp"

using mpm::sorted_quantile;

TEST_CASE("quantiles between order statistics") {
  const std::vector<double> values = {1.0, 2.0, 4.0, 8.0};
  CHECK(sorted_quantile(values, 0.0) == 1.0);
  CHECK(sorted_quantile(values, 1.0) == 8.0);
  CHECK(sorted_quantile(values, 0.5) == 3.0);
  CHECK(sorted_quantile(values, 0.25) == 1.75);  // position 0.75
  CHECK(sorted_quantile({7.0}, 0.3) == 7.0);
}

TEST_CASE("the upper median is one of the values, in any order") {
  CHECK(mpm::upper_median({7.0}) == 7.0);
  CHECK(mpm::upper_median({8.0, 1.0, 2.0}) == 2.0);
  CHECK(mpm::upper_median({8.0, 1.0, 4.0, 2.0}) == 4.0);  // the other one in the middle is 2
}

TEST_CASE("quantiles refuse impossible input") {
  CHECK_THROWS_AS(sorted_quantile({}, 0.5), mpm::InputError);
  CHECK_THROWS_AS(mpm::upper_median({}), mpm::InputError);
  CHECK_THROWS_AS(sorted_quantile({1.0}, -0.1), mpm::InputError);
  CHECK_THROWS_AS(sorted_quantile({1.0}, 1.1), mpm::InputError);
}
