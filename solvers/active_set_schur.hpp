#pragma once

#include <Eigen/Core>

#include "solvers/qp.hpp"

namespace mpm {

/// Cholesky factor S = L L' of a symmetric positive definite matrix that grows and shrinks by one row and
/// column: the Schur complement of the working set of the dual active-set method. All memory is taken at
/// construction.
class SchurFactor {
 public:
  /// For up to `capacity` rows.
  explicit SchurFactor(Eigen::Index capacity);

  Eigen::Index size() const { return size_; }
  void clear() { size_ = 0; }

  /// Appends a row to S, which has the products c with the present rows and the diagonal s. `lower` is inv(L)
  /// c, as `solve_lower` gives it, and `left` is what remains of the diagonal, s - lower' lower. Returns
  /// false, and appends nothing, if there is no room or if nothing remains (`left` <= 0, or NaN).
  bool append(const Eigen::Ref<const Eigen::VectorXd>& lower, double left);

  /// Removes row and column `k`; the later ones move up.
  void remove(Eigen::Index k);

  /// inv(L) b, inv(L') b and inv(S) b in place, for the first `size()` numbers.
  void solve_lower(Eigen::VectorXd& b) const;
  void solve_upper(Eigen::VectorXd& b) const;
  void solve_in_place(Eigen::VectorXd& b) const;

 private:
  RowMajorMatrix lower_;
  Eigen::VectorXd cosine_, sine_;  ///< of the rotations of `remove`
  Eigen::Index size_ = 0;
};

}  // namespace mpm
