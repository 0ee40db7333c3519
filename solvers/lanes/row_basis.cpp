#include "solvers/lanes/row_basis.hpp"

#include <limits>

namespace mpm {
namespace {

// The remainder of a row counts as rounding up to this share of the longest row: some times that of a sum.
constexpr double kRowRounding = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace

std::optional<Eigen::MatrixXd> row_basis(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::Index most) {
  Eigen::MatrixXd left = rows.transpose();  // a row is a column here
  Eigen::MatrixXd basis(rows.cols(), most);
  const double longest = left.size() > 0 ? left.colwise().squaredNorm().maxCoeff() : 0.0;
  for (Eigen::Index rank = 0;; ++rank) {
    Eigen::Index pivot = 0;
    const double largest = left.size() > 0 ? left.colwise().squaredNorm().maxCoeff(&pivot) : 0.0;
    if (largest <= kRowRounding * kRowRounding * longest)
      return Eigen::MatrixXd(basis.leftCols(rank).transpose());
    if (rank == most)
      return std::nullopt;
    const auto before = basis.leftCols(rank);
    auto direction = basis.col(rank);
    direction = left.col(pivot).normalized();
    direction -= before * (before.transpose() * direction);
    direction.normalize();
    left.noalias() -= direction * (direction.transpose() * left);
  }
}

}  // namespace mpm
