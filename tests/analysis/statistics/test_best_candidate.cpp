#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "analysis/statistics/best_candidate.hpp"

using mpm::best_candidate;
using mpm::kInfinity;
using mpm::kNaN;
using mpm::larger_or_nan;
using mpm::required_best_candidate;

namespace {

std::ptrdiff_t place(const std::vector<double>& values) {
  return best_candidate(values) - values.begin();
}

}  // namespace

TEST_CASE("best candidate: the largest number, of several the first, wherever NaN and -infinity stand") {
  CHECK(place({1.0, 3.0, 2.0, 3.0}) == 1);
  CHECK(place({kNaN, 1.0, kNaN, 2.0, kNaN}) == 3);
  CHECK(place({-kInfinity, -1e308, kNaN}) == 1);
  CHECK(place({1.0, kInfinity, kInfinity}) == 1);
  const std::vector<double> values{3.0, kNaN, 1.0, 1.0};
  CHECK(best_candidate(values, std::negate<>()) - values.begin() == 2);
  const Eigen::ArrayXd array = Eigen::Array3d(kNaN, -2.0, -3.0);
  CHECK(best_candidate(array) - array.begin() == 1);
  const std::vector<std::string> words{"a", "bbb", "cc"};
  CHECK(*best_candidate(words, &std::string::size) == "bbb");
}

TEST_CASE("best candidate: without a candidate there is no place, and who needs one is told") {
  for (const std::vector<double>& none : {std::vector<double>{}, {kNaN}, {kNaN, -kInfinity}}) {
    CHECK(best_candidate(none) == none.end());
    CHECK_THROWS_WITH(required_best_candidate("likelihoods", none),
                      "likelihoods: found no number; allowed: one or more");
  }
}

TEST_CASE("best candidate: the larger one of two numbers is NaN where one of them is") {
  CHECK(larger_or_nan(1.0, 2.0) == 2.0);
  CHECK(larger_or_nan(2.0, -kInfinity) == 2.0);
  CHECK(std::isnan(larger_or_nan(kNaN, 1.0)));
  CHECK(std::isnan(larger_or_nan(1.0, kNaN)));
}
