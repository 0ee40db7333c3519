#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/mutual_information.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {

TEST_CASE("mutual information: a signal with itself, with what stands still, and with few levels") {
  const Eigen::VectorXd x = testing::white_noise(400, 1);
  const BinnedInformation same = binned_information(x, x, 4);
  CHECK(same.information == Approx(std::log(4.0)));
  // chi^2(9) at 800 ln 4: what is left out of its leading term is 3.5 / 554.5 of the whole.
  CHECK(same.log_p ==
        Approx(-400 * std::log(4.0) + 3.5 * std::log(400 * std::log(4.0)) - std::lgamma(4.5)).margin(0.01));
  CHECK(binned_information(x, Eigen::VectorXd::Constant(400, 3.0), 4).log_p == 0.0);
  Eigen::VectorXd levels = (x.array() > 0.0).cast<double>();
  const double share = levels.mean();
  CHECK(binned_information(levels, levels, 4).information ==
        Approx(-share * std::log(share) - (1.0 - share) * std::log(1.0 - share)));
  // Uncorrelated, and yet one follows from the other.
  const Eigen::VectorXd squares = x.array().square();
  CHECK(binned_information(x, squares, 4).log_p < -100.0);
  CHECK_THROWS_WITH(binned_information(x.head(79), x.head(79), 4), Catch::Contains("found 79"));
  CHECK_THROWS_WITH(binned_information(x, x, 1), Catch::Contains("bins"));
}

TEST_CASE("mutual information: independent signals have the p-values that they should, slow ones too") {
  for (const double a : {0.0, 0.95}) {
    int hits = 0;
    for (std::uint64_t number = 0; number < 1000; ++number) {
      const BinnedInformation found = binned_information(
          testing::white_noise(400, 2 * number), testing::settled_autoregression(400, a, 2 * number + 1), 4);
      hits += found.log_p < std::log(0.05) ? 1 : 0;
    }
    // 99.9 %: two looks at a law that holds for large counts; here are 25 a pair of bins.
    const Interval rate = testing::clopper_pearson_interval(hits, 1000, 0.999);
    INFO("a = " << a << ", " << hits << " of 1000");
    CHECK((rate.lower < 0.05 && rate.upper > 0.05));
  }
}

}  // namespace mpm
