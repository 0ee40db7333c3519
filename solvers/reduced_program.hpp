#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/working_set.hpp"

namespace mpm {

/// An entry of a sparse matrix.
struct MatrixEntry {
  int row;
  int column;
  double value;
};

/// The QP over a working set of row limits, written for an interior-point method:
///
///     minimise    1/2 z'Qz + c'z     over z = (x, e)
///     subject to  lower <= z <= upper,   constraint_lower <= Cz <= constraint_upper
///
/// A soft limit needs neither its slack nor a constraint if the slack belongs to one row alone and has only a
/// quadratic cost w. With its surplus p >= 0, the distance by which the limit is kept, the slack is
///     s = soft_lower - a x + p      or      s = a x - soft_upper + p,
/// and w s^2 goes into the objective. A row may have both limits: their slacks are never positive at once, so
/// that each may have its own. No limit s >= 0 is needed: at the minimiser 2ws is the multiplier of p >= 0.
/// For the range MPC with a slack per CV and sample this leaves a problem with limits of variables only, with
/// 45 + (working rows) unknowns and no constraint; slacks and constraints would make it three times as large.
/// Every other slack is a variable, and its limits and the hard limits are constraints.
class ReducedProgram {
 public:
  explicit ReducedProgram(const QpStructure& structure);

  /// Writes the program of `data` over `set`; it starts from the (x, slack, multipliers) in `start`.
  void assemble(const WorkingSet& set, const QpData& data, const QpResult& start);

  /// Translates a minimiser z, the multipliers of its limits (upper minus lower, >= 0 each) and those of the
  /// constraints back into an answer of the whole problem. Limits outside the working set get multiplier 0.
  void report(const WorkingSet& set, const QpData& data, const Eigen::Ref<const Eigen::VectorXd>& z,
              const Eigen::Ref<const Eigen::VectorXd>& bound_dual,
              const Eigen::Ref<const Eigen::VectorXd>& constraint_dual, QpResult& result) const;

  Eigen::Index variable_count() const { return gradient_.size(); }
  Eigen::Index constraint_count() const { return constraint_lower_.size(); }

  const std::vector<MatrixEntry>& hessian() const { return hessian_; }          ///< Q, lower triangle
  const std::vector<MatrixEntry>& constraints() const { return constraints_; }  ///< C
  const Eigen::VectorXd& gradient() const { return gradient_; }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  const Eigen::VectorXd& constraint_lower() const { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const { return constraint_upper_; }
  const Eigen::VectorXd& start() const { return start_; }

 private:
  bool has_surplus(WorkingRow row) const;
  void number_unknowns(const WorkingSet& set);
  void add_surplus(WorkingRow row, int column, const QpData& data);
  void add_constraint(WorkingRow row, int constraint, const WorkingSet& set, const QpData& data);

  const QpStructure& structure_;
  std::vector<bool> own_slack_;    ///< of each row: quadratic cost only, and no other row uses it
  std::vector<int> column_;        ///< of each working row: column of its surplus, -1 if it has none
  std::vector<int> slack_column_;  ///< of each slack of the working set: its column, -1 if it is eliminated
  Eigen::MatrixXd hessian_of_x_;   ///< lower triangle
  std::vector<MatrixEntry> hessian_, constraints_;
  Eigen::VectorXd gradient_, lower_, upper_, constraint_lower_, constraint_upper_, start_;
};

}  // namespace mpm
