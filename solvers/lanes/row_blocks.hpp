#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "base/row_major.hpp"
#include "solvers/lanes/lane_kernels.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// Rows A (m x n) in blocks of eight for the product A x.
///
/// The rows of a prediction repeat themselves: move i has the effect on a controlled variable at sample l
/// that move 0 has at sample l - i. With p = number of MVs, in a run of rows (the samples of one CV),
///
///     A(l + 1, j + p) = A(l, j)
///
/// in all columns but the last p, whose moves are held to the end of the horizon. If that holds to the bit,
/// only one series of numbers is kept for each of the first and of the last p columns of a run, and the
/// columns of a block are windows of these series: a few kilobytes, which stay in the nearest cache, instead
/// of all of A.
///
/// After the last move a CV is on its own: from there on, the rows of a run are the free response of a model
/// of low order, and hence combinations of a few rows Q, A = P Q with P = A Q' (row_basis). If that is less
/// work, they are kept as P and Q, and their product is P (Q x), whose rounding is that of A x.
class RowBlocks {
 public:
  explicit RowBlocks(const RowMajorMatrix& rows);

  /// out = A x; `out` is followed by room for a multiple of eight.
  void multiply(const double* x, LaneVector& out) const;

  /// The columns in the order in which their products are added, the same in all rows but those of P.
  const std::vector<int>& column_order() const { return order_; }

  /// Number of rows that are kept as P, in blocks of eight.
  Eigen::Index late_row_count() const;

  /// Numbers that are kept for A.
  std::size_t number_count() const;

 private:
  /// Rows first to last - 1; each is the row before it, moved by a period.
  struct Run {
    Eigen::Index first, last;
  };
  /// Blocks that follow each other from row `first` on, each column by column.
  struct Blocks {
    Eigen::Index first = 0;
    std::vector<int> columns = {};
    long count = 0;
    LaneMemory numbers = {};

    void multiply(const double* x, double* out) const;
  };

  static std::vector<Run> find_runs(const RowMajorMatrix& rows, Eigen::Index period);
  static Eigen::Index find_period(const RowMajorMatrix& rows);
  static Blocks make_blocks(const RowMajorMatrix& rows, Eigen::Index first, Eigen::Index last,
                            std::vector<int> columns);
  void add_taps(Eigen::Index period, Eigen::Index moves, Eigen::Index length);
  void add_windows(const RowMajorMatrix& rows, Eigen::Index period, const std::vector<Run>& runs);
  void add_whole(const RowMajorMatrix& rows, const std::vector<Run>& runs);
  void add_late(const RowMajorMatrix& rows, const std::vector<Run>& runs);

  std::vector<int> order_;
  LaneMemory numbers_;  ///< series
  std::vector<RowTap> taps_;
  long pairs_ = 0;
  Eigen::Index window_blocks_ = 0;  ///< first blocks of every run, which are windows
  std::vector<long> starts_, window_rows_;

  std::vector<Blocks> whole_;  ///< blocks to be multiplied by x
  Blocks basis_;               ///< Q of all runs, one below the other
  std::vector<Blocks> late_;   ///< P of each run, to be multiplied by its part of Q x
};

}  // namespace mpm
