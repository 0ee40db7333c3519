#include <catch2/catch.hpp>

#include "analysis/identification/sum_of_outer_products.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {

TEST_CASE("the sum of outer products, over more than two blocks and read twice") {
  constexpr Eigen::Index p = 3, N = 150;
  const Eigen::MatrixXd v = testing::white_noise(p * N, 7).reshaped(p, N);
  SumOfOuterProducts sum(p);
  CHECK(sum.lower() == Eigen::MatrixXd::Zero(p, p));
  for (Eigen::Index k = 0; k < N; ++k)
    sum.next() = v.col(k);
  const Eigen::MatrixXd expected = (v * v.transpose()).triangularView<Eigen::Lower>();
  CHECK((sum.lower() - expected).norm() < 1e-12 * expected.norm());
  CHECK(sum.lower() == sum.lower());
  sum.next() = v.col(0);
  const Eigen::MatrixXd one_more = (v.col(0) * v.col(0).transpose()).triangularView<Eigen::Lower>();
  CHECK((sum.lower() - expected - one_more).norm() < 1e-12 * expected.norm());
}

}  // namespace mpm
