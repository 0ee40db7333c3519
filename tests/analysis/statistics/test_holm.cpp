#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/holm.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

TEST_CASE("Holm: the adjusted values of a worked example, in the order of the tests", "[holm]") {
  // 4 x 0.005, 3 x 0.01, 2 x 0.03, 1 x 0.04, which is below the one before it.
  const std::vector<double> p{0.01, 0.04, 0.03, 0.005};
  const std::vector<double> expected{0.03, 0.06, 0.06, 0.02};
  const std::vector<double> adjusted = holm_adjusted(p);
  REQUIRE(adjusted.size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(adjusted[i] == Approx(expected[i]).epsilon(1e-12));
}

TEST_CASE("Holm: one test is not corrected, ties are treated alike, nothing exceeds one", "[holm]") {
  CHECK(holm_adjusted({}).empty());
  CHECK(holm_adjusted(std::vector{0.2}) == std::vector{0.2});
  CHECK(holm_adjusted(std::vector{0.5, 0.5, 1.0}) == std::vector{1.0, 1.0, 1.0});
  const std::vector<double> tied = holm_adjusted(std::vector{0.02, 0.9, 0.02});
  CHECK(tied[0] == tied[2]);
  CHECK_THROWS_AS(holm_adjusted(std::vector{0.1, 1.5}), InputError);
}

}  // namespace
}  // namespace mpm
