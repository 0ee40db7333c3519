#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Cholesky factor of a principal submatrix: M_FF = L L' for the symmetric matrix M and an index set F.
///
/// Made for a few dozen variables, where a library's blocked kernels cost more than the arithmetic. All
/// memory is taken at construction.
class ActiveSetFactor {
 public:
  /// For matrices of up to `size` rows.
  explicit ActiveSetFactor(Eigen::Index size);

  /// Factors M_FF, reading the lower triangle of `matrix` only; `free` is F in increasing order. Returns
  /// false when M_FF is not numerically positive definite: then there is no factor.
  bool compute(const Eigen::MatrixXd& matrix, const std::vector<int>& free);

  /// Solves M_FF x_F = b_F in place: the entries F of `vector` are replaced, the others are kept.
  void solve_in_place(Eigen::VectorXd& vector);

 private:
  void gather(const Eigen::MatrixXd& matrix);
  bool factor_panel(Eigen::Index begin, Eigen::Index end);
  void update_trailing(Eigen::Index begin, Eigen::Index end);

  Eigen::MatrixXd factor_;  ///< L in the lower triangle of the leading block
  Eigen::VectorXd packed_;
  std::vector<int> free_;
};

}  // namespace mpm
