#include "solvers/active_set_schur.hpp"

#include <cmath>

namespace mpm {

SchurFactor::SchurFactor(Eigen::Index capacity)
    : lower_(capacity, capacity), cosine_(capacity), sine_(capacity) {}

bool SchurFactor::append(const Eigen::Ref<const Eigen::VectorXd>& lower, double left) {
  if (size_ == lower_.rows() || !(left > 0.0))
    return false;
  lower_.row(size_).head(size_) = lower.head(size_).transpose();
  lower_(size_, size_) = std::sqrt(left);
  ++size_;
  return true;
}

// When row k is removed, the rows below it lose column k. Plane rotations give its outer product back to the
// triangle that remains. Each row takes the rotations of the rows above it, one after the other, and then
// makes its own.
void SchurFactor::remove(Eigen::Index k) {
  --size_;
  for (Eigen::Index i = k; i < size_; ++i) {
    const auto below = lower_.row(i + 1);
    auto row = lower_.row(i);
    row.head(k) = below.head(k);
    double removed = below(k);
    for (Eigen::Index j = k; j < i; ++j) {
      const double entry = below(j + 1);
      row(j) = cosine_(j) * entry + sine_(j) * removed;
      removed = cosine_(j) * removed - sine_(j) * entry;
    }
    const double pivot = below(i + 1);
    const double length = std::sqrt(pivot * pivot + removed * removed);
    row(i) = length;
    cosine_(i) = pivot / length;
    sine_(i) = removed / length;
  }
}

void SchurFactor::solve_lower(Eigen::VectorXd& b) const {
  for (Eigen::Index i = 0; i < size_; ++i)
    b(i) = (b(i) - lower_.row(i).head(i).dot(b.head(i))) / lower_(i, i);
}

void SchurFactor::solve_upper(Eigen::VectorXd& b) const {
  for (Eigen::Index i = size_ - 1; i >= 0; --i) {
    b(i) /= lower_(i, i);
    b.head(i) -= b(i) * lower_.row(i).head(i).transpose();
  }
}

void SchurFactor::solve_in_place(Eigen::VectorXd& b) const {
  solve_lower(b);
  solve_upper(b);
}

}  // namespace mpm
