#pragma once

#include <vector>

#include "solvers/qp.hpp"

namespace mpm {

/// One limit of one row of a QP.
enum class RowSide { hard, soft_lower, soft_upper };  // a hard row enters with both limits at once

/// A row limit that a reduced problem keeps.
struct WorkingRow {
  int row;
  RowSide side;
};

/// The row limits of a QP that a reduced problem keeps, and the slacks they need.
///
/// The reduced problem drops every other row limit, so its feasible set contains that of the full problem.
/// When its minimiser violates none of the dropped limits, it is therefore the minimiser of the full one:
/// the set is grown until that holds. Rows never leave the set within one solve, which bounds the rounds.
class WorkingSet {
 public:
  explicit WorkingSet(const QpStructure& structure);

  void clear();

  /// Every limit that exists.
  void fill(const QpStructure& structure, const QpData& data);

  /// Adds the limits that push in `answer`: those with a multiplier above `tolerance`.
  void add_active(const QpStructure& structure, const QpData& data, const QpResult& answer, double tolerance);

  /// Adds the limits that (x, slack) violates, or comes nearer to than `margin`. Returns how many of the
  /// added ones were violated by more than `tolerance`: zero means that nothing was left out wrongly.
  int add_violated(const QpStructure& structure, const QpData& data, const Eigen::VectorXd& x,
                   const Eigen::VectorXd& slack, double margin, double tolerance);

  const std::vector<WorkingRow>& rows() const { return rows_; }
  /// Indices of the slacks in use, in order of entry.
  const std::vector<int>& slacks() const { return slacks_; }
  /// Position of slack q in `slacks()`, -1 when it is not in use.
  int slack_position(int q) const { return slack_position_[static_cast<std::size_t>(q)]; }

 private:
  struct Member {
    bool hard = false, soft_lower = false, soft_upper = false;
  };

  void add(int row, RowSide side, int slack);

  std::vector<Member> members_;
  std::vector<WorkingRow> rows_;
  std::vector<int> slacks_;
  std::vector<int> slack_position_;
  Eigen::VectorXd row_value_;
};

}  // namespace mpm
