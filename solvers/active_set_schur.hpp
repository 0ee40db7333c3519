#pragma once

#include <Eigen/Core>

namespace mpm {

/// Cholesky factor L L' of a symmetric positive definite matrix that grows and shrinks by one row and column:
/// the Schur complement of the working set of the dual active-set method. All memory is taken at
/// construction.
class SchurFactor {
 public:
  /// For up to `capacity` rows.
  explicit SchurFactor(Eigen::Index capacity) : lower_(capacity, capacity), removed_(capacity) {}

  Eigen::Index size() const { return size_; }
  void clear() { size_ = 0; }

  /// Appends the row (column, diagonal); `column` are its `size()` products with the rows there are. Returns
  /// false, and appends nothing, when the new row depends on them (what is left of its diagonal is below
  /// `smallest` times the diagonal) or when there is no room.
  bool append(const Eigen::Ref<const Eigen::VectorXd>& column, double diagonal, double smallest);

  /// Takes out row and column `k`; the later ones move up.
  void remove(Eigen::Index k);

  /// Solves L L' x = b in place for the first `size()` entries.
  void solve_in_place(Eigen::Ref<Eigen::VectorXd> b) const;

 private:
  Eigen::MatrixXd lower_;
  Eigen::VectorXd removed_;
  Eigen::Index size_ = 0;
};

}  // namespace mpm
