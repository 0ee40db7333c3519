#pragma once

#include <optional>

#include <Eigen/Core>

namespace mpm {

/// An orthonormal basis Q (rank x n) of rows A (m x n): A = (A Q') Q within rounding. By the method of Gram
/// and Schmidt, applied twice to each row, the row with the largest remainder first (Golub and Van Loan,
/// Matrix Computations, 5.2.8 and 5.4.2). Nothing if the rank is above `most`.
std::optional<Eigen::MatrixXd> row_basis(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::Index most);

}  // namespace mpm
