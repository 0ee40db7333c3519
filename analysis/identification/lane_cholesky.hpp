#pragma once

#include <Eigen/Core>

#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// The Cholesky factorisation S = L L' of a positive definite matrix, by the kernels of the active-set
/// method. Successive matrices of the same size use the same memory.
class LaneCholesky {
 public:
  /// Factorises S, given its lower triangle.
  /// @returns false when a pivot is not above `smallest` times its diagonal
  bool compute(const Eigen::Ref<const Eigen::MatrixXd>& S, double smallest);
  /// The least pivot: the square of the least element on the diagonal of L.
  double least_pivot() const;
  /// Returns the x with S x = b.
  Eigen::VectorXd solve(const Eigen::Ref<const Eigen::VectorXd>& b);

 private:
  Eigen::Index n_ = 0;
  LaneMatrix matrix_{0, 0};  ///< S, and the unit matrix in the rest of the last eight rows
  LaneMatrix lower_{0, 0};
  LaneVector inverse_, x_;
};

}  // namespace mpm
