#include <algorithm>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/mcnemar.hpp"
#include "base/error.hpp"

namespace {

using mpm::mcnemar_test;
using mpm::McNemarTest;

/// P(X >= least) for fair coins by counting: Pascal's triangle in whole numbers, exact up to 60 coins.
double counted_tail(int least, int coins) {
  std::vector<std::uint64_t> row{1};
  for (int n = 0; n < coins; ++n) {
    row.push_back(0);
    for (std::size_t k = row.size() - 1; k > 0; --k)
      row[k] += row[k - 1];
  }
  std::uint64_t sum = 0;
  for (std::size_t k = static_cast<std::size_t>(least); k < row.size(); ++k)
    sum += row[k];
  return static_cast<double>(sum) / static_cast<double>(std::uint64_t{1} << coins);
}

TEST_CASE("mcnemar: the p-values are those of counted coins") {
  for (int lost = 0; lost <= 30; ++lost)
    for (int gained = 0; gained <= 30; ++gained) {
      const McNemarTest test = mcnemar_test(lost, gained);
      INFO(lost << " lost, " << gained << " gained");
      CHECK(test.lost == lost);
      CHECK(test.gained == gained);
      // The tail comes from a continued fraction; a dozen digits are more than anybody decides by.
      CHECK(test.p_worse == Approx(counted_tail(lost, lost + gained)).epsilon(1e-12));
      const double two_sided = 2.0 * counted_tail(std::max(lost, gained), lost + gained);
      CHECK(test.p_two_sided == Approx(std::min(1.0, two_sided)).epsilon(1e-12));
    }
}

TEST_CASE("mcnemar: without a disagreement nothing is shown") {
  CHECK(mcnemar_test(0, 0).p_worse == 1.0);
  CHECK(mcnemar_test(0, 0).p_two_sided == 1.0);
  CHECK(mcnemar_test(0, 9).p_worse == 1.0);
}

TEST_CASE("mcnemar: five losses without a gain are the fewest below 5 %") {
  CHECK(mcnemar_test(4, 0).p_worse == Approx(1.0 / 16.0));
  CHECK(mcnemar_test(5, 0).p_worse == Approx(1.0 / 32.0));
}

TEST_CASE("mcnemar: many disagreements follow the chi-square form with continuity correction") {
  // (|b - c| - 1)^2 / (b + c) = 3.8025 is the square of z = 1.95; the two-sided normal tail of it is 0.0512.
  CHECK(mcnemar_test(220, 180).p_two_sided == Approx(0.0512).margin(0.0005));
}

TEST_CASE("mcnemar: negative numbers are refused by name") {
  CHECK_THROWS_WITH(mcnemar_test(-1, 0), "number of losses: found -1; allowed: 0 or more");
  CHECK_THROWS_WITH(mcnemar_test(0, -2), "number of gains: found -2; allowed: 0 or more");
}

}  // namespace
