#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "analysis/identification/group_lasso.hpp"
#include "base/error.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

/// Two columns from each of `groups` orthonormal pairs of noise, which are not orthogonal to each other.
Eigen::MatrixXd pairs(Eigen::Index rows, Eigen::Index groups) {
  Eigen::MatrixXd Q(rows, 2 * groups);
  for (Eigen::Index j = 0; j < groups; ++j) {
    Eigen::MatrixXd pair(rows, 2);
    pair.col(0) = testing::settled_autoregression(rows, 0.9, 300 + static_cast<std::uint64_t>(j));
    pair.col(1) = testing::settled_autoregression(rows, 0.9, 400 + static_cast<std::uint64_t>(j));
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(pair);
    Q.middleCols(2 * j, 2) = qr.householderQ() * Eigen::MatrixXd::Identity(rows, 2);
  }
  return Q;
}

}  // namespace

TEST_CASE("group lasso: groups orthogonal to each other are each shrunk by their penalty or left out") {
  const Eigen::VectorXd c = (Eigen::VectorXd(5) << 3.0, 4.0, 0.3, 0.4, -2.0).finished();
  const Eigen::VectorXd b =
      group_lasso(Eigen::MatrixXd::Identity(5, 5), c, {2, 2, 1}, Eigen::Vector3d(1.0, 0.6, 0.5));
  // |(3, 4)| = 5 loses 1, |(0.3, 0.4)| = 0.5 is below 0.6, and |-2| loses 0.5.
  CHECK(b.isApprox((Eigen::VectorXd(5) << 2.4, 3.2, 0.0, 0.0, -1.5).finished(), 1e-14));
  CHECK(b.segment(2, 2).isZero(0.0));
}

TEST_CASE(
    "group lasso: the answer meets the conditions of a minimum, also where groups depend on each other") {
  for (const Eigen::Index rows : {5, 40}) {  // 8 columns of length 5 are dependent
    const Eigen::MatrixXd Q = pairs(rows, 4);
    const Eigen::VectorXd r = 3.0 * testing::white_noise(rows, 7) + 9.0 * Q.col(2);
    const Eigen::VectorXd penalty = Eigen::Vector4d(2.0, 3.0, 4.0, 5.0);
    const Eigen::VectorXd b = group_lasso(Q.transpose() * Q, Q.transpose() * r, {2, 2, 2, 2}, penalty);
    Eigen::Index left_out = 0;
    for (Eigen::Index j = 0; j < 4; ++j) {
      const Eigen::Vector2d slope = Q.middleCols(2 * j, 2).transpose() * (r - Q * b);
      const Eigen::Vector2d own = b.segment(2 * j, 2);
      left_out += own.isZero(0.0) ? 1 : 0;
      // The descent ends within 1e-10 of |c|, some 10.
      if (own.isZero(0.0))
        CHECK(slope.norm() <= penalty(j) + 1e-7);
      else
        CHECK((slope - penalty(j) * own.normalized()).norm() < 1e-7);
    }
    CHECK(left_out < 4);
  }
}

TEST_CASE("group lasso: without penalty it is least squares, with a large one nothing is selected") {
  const Eigen::MatrixXd Q = pairs(60, 3);
  const Eigen::VectorXd r = testing::white_noise(60, 8);
  const Eigen::VectorXd b =
      group_lasso(Q.transpose() * Q, Q.transpose() * r, {2, 2, 2}, Eigen::Vector3d::Zero());
  CHECK((Q.transpose() * (r - Q * b)).norm() < 1e-7);
  CHECK(group_lasso(Q.transpose() * Q, Q.transpose() * r, {2, 2, 2}, Eigen::Vector3d::Constant(r.norm()))
            .isZero(0.0));
}

TEST_CASE("group lasso: products that fit no groups, and penalties below 0 are refused") {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::Vector2d c(1.0, 2.0);
  const Eigen::VectorXd penalty = Eigen::VectorXd::Ones(1);
  CHECK_THROWS_WITH(group_lasso(one, c, {3}, penalty), Catch::Contains("3 columns"));
  CHECK_THROWS_WITH(group_lasso(one, c, {2}, Eigen::Vector2d::Ones()), Catch::Contains("1, one a group"));
  CHECK_THROWS_WITH(group_lasso(one, c, {2}, -penalty), Catch::Contains("0 or more"));
  CHECK_THROWS_WITH(group_lasso(2.0 * one, c, {2}, penalty), Catch::Contains("orthonormal"));
}

}  // namespace mpm
