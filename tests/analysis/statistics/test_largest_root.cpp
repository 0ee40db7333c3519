#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "analysis/statistics/f_distribution.hpp"
#include "analysis/statistics/largest_root.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

/// B B'/b with B of p x b independent normal numbers.
Eigen::MatrixXd wishart(Eigen::Index p, Eigen::Index b, std::uint64_t number) {
  const Eigen::MatrixXd B = testing::white_noise(p * b, number).reshaped(p, b);
  return B * B.transpose() / static_cast<double>(b);
}

}  // namespace

TEST_CASE(
    "largest root: pairs of covariance matrices of the same law exceed the quantile as often as it says") {
  constexpr int kPairs = 1000;
  constexpr double kProbability = 0.1;  // the more that exceed it, the closer the bounds
  for (const Eigen::Index p : {2, 3, 7})
    for (const auto& [b, a] : {std::pair<Eigen::Index, Eigen::Index>{40, 20}, {60, 60}, {15, 100}}) {
      const double limit =
          largest_root_upper_quantile(kProbability, p, static_cast<double>(b), static_cast<double>(a));
      int above = 0;
      for (int i = 0; i < kPairs; ++i) {
        const auto number = static_cast<std::uint64_t>(910000 + 2 * i);
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> roots(
            wishart(p, b, number), wishart(p, a, number + 1), Eigen::EigenvaluesOnly);
        above += roots.eigenvalues()(p - 1) > limit ? 1 : 0;
      }
      INFO(p << " variables, " << b << " and " << a << " degrees of freedom: " << above);
      // Johnstone's approximation is off by some tenths of the probability, to the safe side.
      const Interval share = testing::clopper_pearson_interval(above, kPairs, 0.998);
      CHECK(share.lower <= kProbability);
      CHECK(share.upper >= 0.7 * kProbability);
    }
}

TEST_CASE("largest root: an F ratio of one variable; more variables and fewer freedoms make it larger") {
  CHECK(largest_root_upper_quantile(0.025, 1, 12.0, 30.0) == f_upper_quantile(0.025, 12.0, 30.0));
  double last = 0.0;
  for (const Eigen::Index p : {1, 2, 3, 5, 10, 25}) {
    const double limit = largest_root_upper_quantile(0.025, p, 40.5, 30.2);
    CHECK(limit > last);
    last = limit;
  }
  CHECK(largest_root_upper_quantile(0.01, 3, 40.0, 30.0) > largest_root_upper_quantile(0.025, 3, 40.0, 30.0));
  CHECK(largest_root_upper_quantile(0.025, 3, 20.0, 30.0) >
        largest_root_upper_quantile(0.025, 3, 40.0, 30.0));
  CHECK(largest_root_upper_quantile(0.025, 3, 40.0, 20.0) >
        largest_root_upper_quantile(0.025, 3, 40.0, 30.0));
  CHECK(largest_root_upper_quantile(0.025, 3, 1e8, 1e8) == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("largest root: no finite quantile where A does not fill the space; what is refused") {
  CHECK(largest_root_upper_quantile(0.025, 3, 40.0, 3.0) == kInfinity);
  CHECK(largest_root_upper_quantile(0.025, 3, 40.0, 1.5) == kInfinity);
  CHECK(largest_root_upper_quantile(0.025, 3, 0.9, 40.0) == kInfinity);
  CHECK(std::isfinite(largest_root_upper_quantile(0.025, 3, 1.0, 40.0)));
  CHECK_THROWS_WITH(largest_root_upper_quantile(0.025, 0, 40.0, 40.0), Catch::Contains("found 0"));
  CHECK_THROWS_WITH(largest_root_upper_quantile(0.025, 2, 0.0, 40.0), Catch::Contains("degrees of freedom"));
}

}  // namespace mpm
