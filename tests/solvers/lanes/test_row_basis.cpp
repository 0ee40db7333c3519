#include <cstdlib>
#include <optional>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "solvers/lanes/row_basis.hpp"

namespace mpm {

TEST_CASE("a basis of rows is orthonormal, gives them back and has their rank", "[lanes]") {
  std::srand(11);
  for (const Eigen::Index rank : {0, 1, 4, 9}) {
    CAPTURE(rank);
    // Rows of all sizes, and combinations that are nearly parallel.
    Eigen::MatrixXd factors = Eigen::MatrixXd::Random(40, rank);
    for (Eigen::Index i = 0; i < 40; ++i)
      factors.row(i) *= i % 2 == 0 ? 1e-3 : 1e3;
    const Eigen::MatrixXd rows =
        factors * (Eigen::MatrixXd::Ones(rank, 15) + 1e-3 * Eigen::MatrixXd::Random(rank, 15));
    const std::optional<Eigen::MatrixXd> basis = row_basis(rows, 15);
    REQUIRE(basis.has_value());
    REQUIRE(basis->rows() == rank);
    REQUIRE(basis->cols() == 15);
    CHECK((*basis * basis->transpose() - Eigen::MatrixXd::Identity(rank, rank)).norm() <= 1e-14);
    CHECK((rows - rows * basis->transpose() * *basis).norm() <= 1e-14 * rows.norm());
    CHECK(row_basis(rows, rank).has_value());
    if (rank > 0)
      CHECK_FALSE(row_basis(rows, rank - 1).has_value());
  }
}

TEST_CASE("rows that are not there have an empty basis", "[lanes]") {
  const std::optional<Eigen::MatrixXd> basis = row_basis(Eigen::MatrixXd(0, 5), 3);
  REQUIRE(basis.has_value());
  CHECK(basis->rows() == 0);
  CHECK(basis->cols() == 5);
}

}  // namespace mpm
