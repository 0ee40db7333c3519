#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// Cholesky factor of a principal submatrix: M_FF = L L' for the symmetric matrix M and an index set F.
///
/// All memory is taken at construction.
class ActiveSetFactor {
 public:
  /// For matrices of up to `size` rows.
  explicit ActiveSetFactor(Eigen::Index size);

  /// Factors M_FF, reading the lower triangle of `matrix` only; `free` is F in increasing order. Returns
  /// false if M_FF is not numerically positive definite; then there is no factor. After its own columns,
  /// `matrix` has those of the unit matrix up to its stride.
  bool compute(const LaneMatrix& matrix, const std::vector<int>& free);

  /// |F| rounded up to a multiple of eight: the length of `packed` below.
  Eigen::Index packed_size() const { return padded(static_cast<Eigen::Index>(free_.size())); }
  /// Copies the entries F of `vector`, followed by zeros, and copies them back.
  void pack(const LaneVector& vector, double* packed) const;
  void unpack(const double* packed, LaneVector& vector) const;
  /// inv(L) b and inv(L') b in place.
  void solve_lower(double* packed) const;
  void solve_upper(double* packed) const;

 private:
  void gather(const LaneMatrix& matrix);

  Eigen::Index size_;
  LaneMatrix gathered_, lower_;
  LaneVector inverse_;  ///< inverses of the blocks on the diagonal of L
  std::vector<int> free_;
};

}  // namespace mpm
