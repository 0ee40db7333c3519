#pragma once

#include <optional>

#include <Eigen/Core>

namespace mpm {

/// An orthonormal basis Q (rank x n) of rows A (m x n): A = (A Q') Q within rounding. By Gram and Schmidt,
/// the row with the most left of it first, each twice (Golub and Van Loan, Matrix Computations, 5.2.8
/// and 5.4.2). Nothing when the rank is above `most`.
std::optional<Eigen::MatrixXd> row_basis(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::Index most);

}  // namespace mpm
