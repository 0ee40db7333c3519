#include "solvers/active_set_factor.hpp"

#include <algorithm>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

constexpr double kSmallestPivot = 4.0e-15;  // relative to the diagonal before elimination; below it is noise

}  // namespace

ActiveSetFactor::ActiveSetFactor(Eigen::Index size)
    : size_(size),
      gathered_(size, padded(size)),
      lower_(size, padded(size)),
      inverse_(LaneKernels::kInverse * padded(size)) {
  free_.reserve(static_cast<std::size_t>(size));
}

bool ActiveSetFactor::compute(const LaneMatrix& matrix, const std::vector<int>& free) {
  free_.assign(free.begin(), free.end());
  const auto count = static_cast<Eigen::Index>(free_.size());
  if (count < size_)
    gather(matrix);
  const LaneMatrix& source = count < size_ ? gathered_ : matrix;
  return lane_kernels().factor(source.data(), source.stride(), padded(count), kSmallestPivot, lower_.data(),
                               inverse_.data());
}

// Gathers M_FF, with the unit matrix in the rest of the last eight rows.
void ActiveSetFactor::gather(const LaneMatrix& matrix) {
  const auto count = static_cast<Eigen::Index>(free_.size());
  const int* index = free_.data();
  for (Eigen::Index j = 0; j < count; ++j) {
    const double* from = matrix.column(index[j]);
    double* to = gathered_.column(j);
    for (Eigen::Index i = j; i < count; ++i)
      to[i] = from[index[i]];
    std::fill(to + count, to + padded(count), 0.0);
  }
  for (Eigen::Index j = count; j < padded(count); ++j) {
    std::fill(gathered_.column(j), gathered_.column(j) + padded(count), 0.0);
    gathered_(j, j) = 1.0;
  }
}

void ActiveSetFactor::pack(const LaneVector& vector, double* packed) const {
  const auto count = static_cast<Eigen::Index>(free_.size());
  for (Eigen::Index i = 0; i < count; ++i)
    packed[i] = vector(free_[static_cast<std::size_t>(i)]);
  std::fill(packed + count, packed + packed_size(), 0.0);
}

void ActiveSetFactor::unpack(const double* packed, LaneVector& vector) const {
  for (std::size_t i = 0; i < free_.size(); ++i)
    vector(free_[i]) = packed[i];
}

void ActiveSetFactor::solve_lower(double* packed) const {
  lane_kernels().solve_lower(lower_.data(), lower_.stride(), packed_size(), inverse_.data(), packed);
}

void ActiveSetFactor::solve_upper(double* packed) const {
  lane_kernels().solve_upper(lower_.data(), lower_.stride(), packed_size(), inverse_.data(), packed);
}

}  // namespace mpm
