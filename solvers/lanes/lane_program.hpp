#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/lanes/lane_vector.hpp"
#include "solvers/lanes/row_blocks.hpp"

namespace mpm {

/// Hessian H (n x n) and rows A (m x n) of a program for the kernels. All sizes and vectors without padding
/// have at least the length that the shape says; `out` is followed by room for a multiple of eight.
class LaneProgram {
 public:
  LaneProgram(const Eigen::MatrixXd& hessian, const RowBlocks::Rows& rows);

  Eigen::Index variable_count() const { return hessian_.columns(); }
  Eigen::Index row_count() const { return rows_.columns(); }

  /// out = A x.
  void multiply_rows(const double* x, LaneVector& out) const;
  /// out += H x.
  void add_hessian(const double* x, LaneVector& out) const;
  /// out += sum over the listed rows of factor_i a_i.
  void add_rows(const std::vector<int>& list, const double* factor, LaneVector& out) const;
  /// The lower triangle of `matrix` += sum over the listed rows of weight_k a_k a_k'; what is above it in the
  /// first n rows and columns is arbitrary afterwards. `scratch`: outer_scratch() numbers.
  void add_outer(const std::vector<int>& list, const std::vector<double>& weight, LaneVector& scratch,
                 LaneMatrix& matrix) const;
  Eigen::Index outer_scratch() const;

 private:
  LaneMatrix hessian_, rows_;  ///< columns: of H, and the rows of A
  RowBlocks blocks_;           ///< the rows for the product with them
};

}  // namespace mpm
