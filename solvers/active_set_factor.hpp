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
  /// false when M_FF is not numerically positive definite: then there is no factor. Beside its own columns
  /// `matrix` has those of the unit matrix up to its stride.
  bool compute(const LaneMatrix& matrix, const std::vector<int>& free);

  /// Solves M_FF x_F = b_F in place: the entries F of `vector` are replaced, the others are kept.
  void solve_in_place(LaneVector& vector);

 private:
  void gather(const LaneMatrix& matrix);

  Eigen::Index size_;
  LaneMatrix gathered_, lower_;
  LaneVector inverse_, packed_;  ///< of the blocks on the diagonal of L
  std::vector<int> free_;
};

}  // namespace mpm
