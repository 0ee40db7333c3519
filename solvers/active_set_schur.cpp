#include "solvers/active_set_schur.hpp"

#include <cmath>

namespace mpm {

bool SchurFactor::append(const Eigen::Ref<const Eigen::VectorXd>& column, double diagonal, double smallest) {
  if (size_ == lower_.rows())
    return false;
  // Row of the factor by forward substitution, kept in the row of the matrix that it becomes.
  double left = diagonal;
  for (Eigen::Index j = 0; j < size_; ++j) {
    double value = column(j);
    for (Eigen::Index i = 0; i < j; ++i)
      value -= lower_(size_, i) * lower_(j, i);
    value /= lower_(j, j);
    lower_(size_, j) = value;
    left -= value * value;
  }
  if (!(left > smallest * diagonal))
    return false;
  lower_(size_, size_) = std::sqrt(left);
  ++size_;
  return true;
}

// Without row k the rows below it have lost the column k: its outer product is given back to the triangle
// that remains by plane rotations.
void SchurFactor::remove(Eigen::Index k) {
  const Eigen::Index below = size_ - 1 - k;
  removed_.head(below) = lower_.col(k).segment(k + 1, below);
  for (Eigen::Index i = k; i + 1 < size_; ++i) {
    for (Eigen::Index j = 0; j < k; ++j)
      lower_(i, j) = lower_(i + 1, j);
    for (Eigen::Index j = k; j <= i; ++j)
      lower_(i, j) = lower_(i + 1, j + 1);
  }
  --size_;
  for (Eigen::Index j = 0; j < below; ++j) {
    double& pivot = lower_(k + j, k + j);
    const double length = std::hypot(pivot, removed_(j));
    const double cosine = pivot / length;
    const double sine = removed_(j) / length;
    pivot = length;
    for (Eigen::Index i = j + 1; i < below; ++i) {
      double& entry = lower_(k + i, k + j);
      const double rotated = cosine * entry + sine * removed_(i);
      removed_(i) = cosine * removed_(i) - sine * entry;
      entry = rotated;
    }
  }
}

void SchurFactor::solve_in_place(Eigen::Ref<Eigen::VectorXd> b) const {
  for (Eigen::Index j = 0; j < size_; ++j) {
    b(j) /= lower_(j, j);
    const Eigen::Index below = size_ - 1 - j;
    b.segment(j + 1, below) -= b(j) * lower_.col(j).segment(j + 1, below);
  }
  for (Eigen::Index j = size_ - 1; j >= 0; --j) {
    const Eigen::Index below = size_ - 1 - j;
    b(j) = (b(j) - lower_.col(j).segment(j + 1, below).dot(b.segment(j + 1, below))) / lower_(j, j);
  }
}

}  // namespace mpm
