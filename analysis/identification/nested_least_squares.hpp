#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/QR>

namespace mpm {

/// The least-squares problems min |A_m x - b| with the first m columns of one matrix, for every m and several
/// right-hand sides, from a single factorisation A = Q R: the residual of the first m columns is the part of
/// Q'b below row m. So a list of model orders costs no more than its largest order, 2 n p^2 operations.
///
/// A column is left out if it depends on the columns before it: if its distance from their span is at most
/// `rank_tolerance` of its length.
///
/// | symbol | meaning                      | shape |
/// |--------|------------------------------|-------|
/// | A      | regressors                   | n x p |
/// | B      | right-hand sides, a column each | n x q |
class NestedLeastSquares {
 public:
  /// @throws InputError if n <= p, B and A have different numbers of rows, or the tolerance is outside (0, 1)
  NestedLeastSquares(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                     double rank_tolerance);

  /// Rank of the first `columns` columns.
  Eigen::Index rank(Eigen::Index columns) const;
  /// Smallest |A_m x - b|^2 with m = `columns`, b = column `side` of B.
  double residual_sum(Eigen::Index columns, Eigen::Index side) const;
  /// A minimiser (m), with 0 for the columns that depend on others.
  Eigen::VectorXd solution(Eigen::Index columns, Eigen::Index side) const;

 private:
  std::vector<Eigen::Index> kept_;  ///< columns of A in the factorisation
  Eigen::VectorXd norms_;           ///< of the kept columns, which are factorised with unit norm
  Eigen::MatrixXd R_;
  Eigen::MatrixXd rotated_;  ///< Q'B
};

}  // namespace mpm
