#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/lanes/lane_kernels.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// Rows A (m x n) in blocks of eight for the product A x.
///
/// The rows of a prediction repeat themselves: what move i does to a controlled variable at sample l is what
/// move 0 does at sample l - i. With p = number of MVs, in a run of rows (the samples of one CV),
///
///     A(l + 1, j + p) = A(l, j)
///
/// in all columns but the last p, whose moves do not end with the horizon. Where that holds to the bit, only
/// one series of numbers is kept for each of the first and of the last p columns of a run, and the columns of
/// a block are windows of them: a few kilobytes, which stay in the nearest cache, instead of all of A.
/// Blocks across the end of a run, and rows without such an order, are kept as they are.
class RowBlocks {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  explicit RowBlocks(const Rows& rows);

  /// out = A x; `out` is followed by room for a multiple of eight.
  void multiply(const double* x, LaneVector& out) const;

  /// The columns in the order in which their products are added, the same in all rows.
  std::vector<int> column_order() const;

  /// Numbers that are kept for A.
  std::size_t number_count() const { return windows_.numbers.size() + whole_.numbers.size(); }

 private:
  struct Set {
    LaneMemory numbers;
    std::vector<RowTap> taps;
    long pairs = 0;
    std::vector<RowRun> runs;
    std::vector<long> row;

    void multiply(const double* x, LaneVector& out) const;
  };
  /// Rows first to last - 1 of a run.
  struct Run {
    Eigen::Index first, last;
  };

  static std::vector<Run> find_runs(const Rows& rows, Eigen::Index period);
  void add_taps(Eigen::Index period, Eigen::Index moves, Eigen::Index length);
  void add_windows(const Rows& rows, Eigen::Index period, const std::vector<Run>& runs);
  void add_whole(const Rows& rows);

  Set windows_, whole_;
};

}  // namespace mpm
