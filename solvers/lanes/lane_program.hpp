#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "base/row_major.hpp"
#include "solvers/lanes/lane_vector.hpp"
#include "solvers/lanes/row_band.hpp"
#include "solvers/lanes/row_blocks.hpp"

namespace mpm {

/// Hessian H (n x n) and rows A (m x n) of a program for the kernels. Sizes and vectors without padding have
/// at least the length that the shape says; `out` has room for a multiple of eight.
///
/// If successive rows have few columns that are not zero, and the same ones (those of a CV that answers to
/// some of the MVs only), only these columns are kept and used. The products left out are zero: the results
/// are the same to the bit (except for the sign of a zero).
class LaneProgram {
 public:
  LaneProgram(const Eigen::MatrixXd& hessian, const RowMajorMatrix& rows);

  Eigen::Index variable_count() const { return hessian_.columns(); }
  Eigen::Index row_count() const { return rows_.columns(); }

  /// out = A x.
  void multiply_rows(const double* x, LaneVector& out) const;
  /// out += H x.
  void add_hessian(const double* x, LaneVector& out) const;
  /// out += sum over the listed rows, in increasing order, of factor_i a_i.
  void add_rows(const std::vector<int>& list, const double* factor, LaneVector& out) const;
  /// The lower triangle of `matrix` += sum over the listed rows, in increasing order, of weight_k a_k a_k'.
  /// The numbers above it in the first n rows and columns are arbitrary afterwards. `scratch`:
  /// outer_scratch() numbers.
  void add_outer(const std::vector<int>& list, const std::vector<double>& weight, LaneVector& scratch,
                 LaneMatrix& matrix) const;
  Eigen::Index outer_scratch() const;

 private:
  bool is_dense() const { return bands_.size() == 1 && bands_.front().width() == variable_count(); }
  void copy_bands();

  LaneMatrix hessian_;
  std::vector<RowBand> bands_;
  LaneMatrix rows_;  ///< each column is a row of A, with the columns of its band only
  /// For the product with the rows: all rows if nothing is left out; otherwise the rows of each band in
  /// groups of eight, each group column by column, and where each band begins.
  std::optional<RowBlocks> dense_;
  LaneMemory blocks_;
  std::vector<std::size_t> begin_;
};

}  // namespace mpm
