#include <catch2/catch.hpp>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/nested_least_squares.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::kRankTolerance;
using mpm::least_squares;
using mpm::NestedLeastSquares;
using mpm::testing::white_noise;

namespace {

Eigen::MatrixXd columns(Eigen::Index rows, Eigen::Index count, std::uint64_t number) {
  return mpm::testing::white_inputs(count, rows, number).transpose();
}

}  // namespace

TEST_CASE("nested least squares: every number of columns has the answer of its own problem") {
  const Eigen::MatrixXd A = columns(60, 7, 301);
  const Eigen::MatrixXd B = columns(60, 3, 302);
  const NestedLeastSquares nested(A, B, kRankTolerance);
  for (Eigen::Index m = 1; m <= 7; ++m)
    for (Eigen::Index side = 0; side < 3; ++side) {
      const mpm::LeastSquares alone = least_squares(A.leftCols(m), B.col(side), kRankTolerance);
      CHECK(nested.rank(m) == m);
      // Two routes through orthogonal transformations of columns with a condition below 10.
      CHECK(nested.residual_sum(m, side) == Approx(alone.residual_sum).epsilon(1e-12));
      CHECK((nested.solution(m, side) - alone.x).norm() < 1e-12);
    }
  CHECK(nested.rank(0) == 0);
  CHECK(nested.residual_sum(0, 1) == Approx(B.col(1).squaredNorm()));
}

TEST_CASE("nested least squares: columns that depend on earlier ones change no residual") {
  const Eigen::MatrixXd independent = columns(50, 3, 303);
  Eigen::MatrixXd A(50, 6);
  A << Eigen::VectorXd::Zero(50), independent.col(0), -2.0 * independent.col(0), independent.col(1),
      independent.col(0) + 3.0 * independent.col(1), independent.col(2);
  const Eigen::VectorXd b = white_noise(50, 304);
  const NestedLeastSquares nested(A, b, kRankTolerance);
  const std::vector<Eigen::Index> ranks{0, 0, 1, 1, 2, 2, 3};
  for (Eigen::Index m = 0; m <= 6; ++m)
    CHECK(nested.rank(m) == ranks[static_cast<std::size_t>(m)]);
  for (Eigen::Index m = 2; m <= 6; ++m) {
    const Eigen::VectorXd x = nested.solution(m, 0);
    CHECK((A.leftCols(m) * x - b).squaredNorm() == Approx(nested.residual_sum(m, 0)));
    CHECK(nested.residual_sum(m, 0) ==
          Approx(least_squares(A.leftCols(m), b, kRankTolerance).residual_sum).epsilon(1e-12));
  }
}

TEST_CASE("nested least squares: what is no such problem is refused") {
  const Eigen::MatrixXd A = columns(5, 5, 305);
  const Eigen::VectorXd b = white_noise(5, 306);
  CHECK_THROWS_WITH(NestedLeastSquares(A, b, kRankTolerance), Catch::Contains("5 for 5 parameters"));
  CHECK_THROWS_WITH(NestedLeastSquares(A.leftCols(2), b.head(4), kRankTolerance),
                    Catch::Contains("found 4 samples; allowed: 5"));
  CHECK_THROWS_WITH(NestedLeastSquares(A.leftCols(2), b, 1.0), Catch::Contains("rank tolerance"));
}
