#include <cmath>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/methods/literature/subspace_angle.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

using mpm::subspace_cosine_limit;
using mpm::subspace_cosines;

TEST_CASE("subspace cosines: a line, a plane, all of space and nothing") {
  const Eigen::Vector3d line(3.0, 0.0, -4.0);
  CHECK(subspace_cosines(line).isApprox(Eigen::Vector3d(0.6, 0.0, 0.8)));
  Eigen::MatrixXd plane(3, 2);
  plane << 1.0, 1.0, 0.0, 1.0, 0.0, 1.0;  // holds e_1 and e_2 + e_3
  CHECK(subspace_cosines(plane).isApprox(Eigen::Vector3d(1.0, std::sqrt(0.5), std::sqrt(0.5))));
  Eigen::MatrixXd space(2, 2);
  space << 1.0, 1.0, 0.0, 1e-6;
  CHECK(subspace_cosines(space).isApprox(Eigen::Vector2d::Ones()));
  CHECK(subspace_cosines(Eigen::MatrixXd(4, 0)) == Eigen::VectorXd::Zero(4));
}

TEST_CASE("subspace cosines: the printed formula, and no matter which columns span the subspace") {
  const Eigen::MatrixXd p = mpm::testing::white_noise(15, 1).reshaped(5, 3);
  const Eigen::MatrixXd projection = p * (p.transpose() * p).inverse() * p.transpose();
  const Eigen::VectorXd cosines = subspace_cosines(p);
  for (Eigen::Index k = 0; k < 5; ++k)
    CHECK(cosines(k) == Approx((projection * Eigen::VectorXd::Unit(5, k)).norm()));
  const Eigen::MatrixXd mixing = mpm::testing::white_noise(9, 2).reshaped(3, 3);
  CHECK(subspace_cosines(p * mixing).isApprox(cosines, 1e-10));
  // The trace of a projection is its rank.
  CHECK(cosines.squaredNorm() == Approx(3.0));
}

TEST_CASE("limit of a subspace cosine: 45 degrees for endless records, more for short ones") {
  // By hand: n_g = sqrt(200 * 800) = 400; 1/2 + 1.959964/sqrt(800) = 0.569295.
  CHECK(subspace_cosine_limit(200, 800, 0.95) == Approx(std::sqrt(0.569295)).epsilon(1e-6));
  CHECK(subspace_cosine_limit(1'000'000'000, 1'000'000'000, 0.95) == Approx(std::sqrt(0.5)).epsilon(1e-4));
  CHECK(subspace_cosine_limit(7, 7, 0.95) > 1.0);
  CHECK(subspace_cosine_limit(8, 8, 0.95) < 1.0);
}

TEST_CASE("subspace angles refuse what cannot be meant") {
  CHECK_THROWS_WITH(subspace_cosines(Eigen::MatrixXd::Ones(2, 3)),
                    Catch::Contains("found 3") && Catch::Contains("2 or fewer"));
  Eigen::Vector2d bad(1.0, mpm::kNaN);
  CHECK_THROWS_WITH(subspace_cosines(bad), Catch::Contains("finite values only"));
  CHECK_THROWS_WITH(subspace_cosine_limit(0, 5, 0.95), Catch::Contains("found 0 and 5"));
  CHECK_THROWS_AS(subspace_cosine_limit(5, 5, 0.0), mpm::InputError);
}
