#include "solvers/active_set_factor.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

constexpr Eigen::Index kPanel = 4;          // columns that update the rest of the matrix together
constexpr double kSmallestPivot = 4.0e-15;  // relative to the diagonal before elimination: below is noise

}  // namespace

ActiveSetFactor::ActiveSetFactor(Eigen::Index size) : factor_(size, size), packed_(size) {
  free_.reserve(static_cast<std::size_t>(size));
}

bool ActiveSetFactor::compute(const Eigen::MatrixXd& matrix, const std::vector<int>& free) {
  free_.assign(free.begin(), free.end());
  gather(matrix);
  const auto count = static_cast<Eigen::Index>(free_.size());
  for (Eigen::Index begin = 0; begin < count; begin += kPanel) {
    const Eigen::Index end = std::min(begin + kPanel, count);
    if (!factor_panel(begin, end))
      return false;
    update_trailing(begin, end);
  }
  return true;
}

void ActiveSetFactor::gather(const Eigen::MatrixXd& matrix) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  const int* index = free_.data();
  for (Eigen::Index j = 0; j < count; ++j) {
    const double* from = matrix.col(index[j]).data();
    double* to = factor_.col(j).data();
    for (Eigen::Index i = j; i < count; ++i)
      to[i] = from[index[i]];
    packed_(j) = to[j];
  }
}

// The columns begin..end-1, whose earlier columns are already subtracted.
bool ActiveSetFactor::factor_panel(Eigen::Index begin, Eigen::Index end) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  for (Eigen::Index k = begin; k < end; ++k) {
    double* column = factor_.col(k).data();
    if (!(column[k] > kSmallestPivot * packed_(k)))  // also false for NaN
      return false;
    const double inverse = 1.0 / std::sqrt(column[k]);
    for (Eigen::Index i = k; i < count; ++i)
      column[i] *= inverse;
    for (Eigen::Index j = k + 1; j < end; ++j) {
      double* other = factor_.col(j).data();
      for (Eigen::Index i = j; i < count; ++i)
        other[i] -= column[j] * column[i];
    }
  }
  return true;
}

void ActiveSetFactor::update_trailing(Eigen::Index begin, Eigen::Index end) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  if (end == count)
    return;  // nothing is left; only a whole panel comes further
  const double* c0 = factor_.col(begin).data();
  const double* c1 = factor_.col(begin + 1).data();
  const double* c2 = factor_.col(begin + 2).data();
  const double* c3 = factor_.col(begin + 3).data();
  for (Eigen::Index j = end; j < count; ++j) {
    double* column = factor_.col(j).data();
    const double l0 = c0[j];
    const double l1 = c1[j];
    const double l2 = c2[j];
    const double l3 = c3[j];
    for (Eigen::Index i = j; i < count; ++i)
      column[i] -= l0 * c0[i] + l1 * c1[i] + l2 * c2[i] + l3 * c3[i];
  }
}

void ActiveSetFactor::solve_in_place(Eigen::VectorXd& vector) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  const int* index = free_.data();
  for (Eigen::Index i = 0; i < count; ++i)
    packed_(i) = vector(index[i]);
  const auto lower = factor_.topLeftCorner(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const double* column = factor_.col(j).data();
    const double value = packed_(j) / column[j];
    packed_(j) = value;
    for (Eigen::Index i = j + 1; i < count; ++i)
      packed_(i) -= value * column[i];
  }
  for (Eigen::Index j = count - 1; j >= 0; --j) {
    const Eigen::Index below = count - 1 - j;
    packed_(j) = (packed_(j) - lower.col(j).tail(below).dot(packed_.segment(j + 1, below))) / lower(j, j);
  }
  for (Eigen::Index i = 0; i < count; ++i)
    vector(index[i]) = packed_(i);
}

}  // namespace mpm
