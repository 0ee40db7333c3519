#include "analysis/identification/lane_cholesky.hpp"

#include <algorithm>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {

bool LaneCholesky::compute(const Eigen::Ref<const Eigen::MatrixXd>& S, double smallest) {
  const Eigen::Index n = S.rows(), size = padded(n);
  if (n != n_) {
    n_ = n;
    matrix_ = LaneMatrix(size, size);
    for (Eigen::Index j = n; j < size; ++j)
      matrix_(j, j) = 1.0;
    lower_ = LaneMatrix(size, size);
    inverse_ = LaneVector(LaneKernels::kInverse * size);
    x_ = LaneVector(size);
  }
  for (Eigen::Index j = 0; j < n; ++j)
    Eigen::Map<Eigen::VectorXd>(matrix_.column(j), n) = S.col(j);
  return lane_kernels().factor(matrix_.data(), size, size, smallest, lower_.data(), inverse_.data());
}

double LaneCholesky::least_pivot() const {
  constexpr Eigen::Index kBlock = 8;
  double largest = 0.0;  // on the diagonals of the inverses of the blocks of L
  for (Eigen::Index j = 0; j < n_; ++j) {
    const double* inverse = inverse_.data() + LaneKernels::kInverse * (j - j % kBlock);
    largest = std::max(largest, inverse[(kBlock + 1) * (j % kBlock)]);
  }
  return 1.0 / (largest * largest);
}

Eigen::VectorXd LaneCholesky::solve(const Eigen::Ref<const Eigen::VectorXd>& b) {
  Eigen::Map<Eigen::VectorXd> x(x_.data(), x_.size());
  x << b, Eigen::VectorXd::Zero(x.size() - n_);
  lane_kernels().solve_lower(lower_.data(), lower_.stride(), lower_.stride(), inverse_.data(), x_.data());
  lane_kernels().solve_upper(lower_.data(), lower_.stride(), lower_.stride(), inverse_.data(), x_.data());
  return x.head(n_);
}

}  // namespace mpm
