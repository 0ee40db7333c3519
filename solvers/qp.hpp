#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/row_major.hpp"
#include "solvers/lanes/lane_program.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// The part of a soft-constrained quadratic program that stays the same over the life of a controller.
///
///     minimise    1/2 x'Hx + g'x + sum_q (w_q s_q^2 + l_q s_q)         over x, s >= 0
///     subject to  lower <= x <= upper
///                 hard_lower_i <= a_i x <= hard_upper_i
///                 soft_lower_i - s_q(i) <= a_i x <= soft_upper_i + s_q(i)
///
/// One row a_i carries its hard and its soft limits; several rows may share one slack (a slack per
/// controlled variable) or have one each (a slack per controlled variable and sample). An absent limit is
/// infinite (-inf below, inf above). The target optimizer (6.19) and the range MPC (6.20) of the thesis are
/// both of this form.
///
/// | symbol | member          | shape | meaning                                              |
/// |--------|-----------------|-------|------------------------------------------------------|
/// | H      | hessian         | n x n | symmetric, positive semidefinite                     |
/// | a_i    | rows            | m x n | one row a line                                       |
/// | q(i)   | slack_of_row    | m     | index of the slack of row i, -1: no soft limits      |
/// | w      | slack_quadratic | q     | >= 0                                                 |
/// | l      | slack_linear    | q     | >= 0; w + l > 0                                      |
struct QpStructure {
  Eigen::MatrixXd hessian;
  RowMajorMatrix rows;
  Eigen::VectorXi slack_of_row;
  Eigen::VectorXd slack_quadratic;
  Eigen::VectorXd slack_linear;

  Eigen::Index variable_count() const { return hessian.rows(); }
  Eigen::Index row_count() const { return rows.rows(); }
  Eigen::Index slack_count() const { return slack_quadratic.size(); }

  /// Throws InputError when shapes, symmetry, weights or slack indices are wrong.
  void validate() const;
};

/// The part of the program that changes from sample to sample; shapes and meaning as in QpStructure.
struct QpData {
  Eigen::VectorXd gradient;                ///< g, n
  Eigen::VectorXd lower, upper;            ///< limits of x, n
  Eigen::VectorXd hard_lower, hard_upper;  ///< hard limits of the rows, m
  Eigen::VectorXd soft_lower, soft_upper;  ///< soft limits of the rows, m

  /// Zero gradient and no limits, of the shape of `structure`.
  static QpData unconstrained(const QpStructure& structure);

  /// Throws InputError when a shape is not that of `structure`, a number is NaN or limits cross.
  void validate(const QpStructure& structure) const;
};

enum class QpStatus { solved, infeasible, iteration_limit, numerical_error, time_limit };

std::string_view to_string(QpStatus status);

/// Minimiser, multipliers and certificate.
///
/// Multipliers are positive at an upper limit and negative at a lower one, so that at the optimum
///     Hx + g + bound_dual + A'(hard_dual + soft_dual) = 0.
struct QpResult {
  QpStatus status = QpStatus::numerical_error;
  Eigen::VectorXd x;           ///< n
  Eigen::VectorXd slack;       ///< q
  Eigen::VectorXd bound_dual;  ///< n
  Eigen::VectorXd hard_dual;   ///< m
  Eigen::VectorXd soft_dual;   ///< m
  double objective = 0.0;      ///< 1/2 x'Hx + g'x + slack terms
  double kkt_residual = 0.0;   ///< see kkt_residual(); infinite unless status is `solved`
  int iterations = 0;          ///< of the back end, all rounds together
  bool certified = false;      ///< `solved`, with a residual small enough for a certificate, see QpSolver
  bool from_ipopt = false;     ///< the fast method gave no certified answer; this one is Ipopt's

  /// All zero, of the shape of `structure`.
  static QpResult zero(const QpStructure& structure);
};

/// Rows `first` to `first + count - 1`, whose slack is the same (QpStructure::slack_of_row).
struct SlackRun {
  Eigen::Index first, count;
  int slack;  ///< -1: none
};
/// Divides all rows, in their order, into runs that are as long as possible.
std::vector<SlackRun> slack_runs(const QpStructure& structure);

/// Objective of (x, s).
double objective(const QpStructure& structure, const QpData& data, const QpResult& result);

/// The largest violation of the Karush-Kuhn-Tucker conditions by (x, s, multipliers):
/// stationarity in x and in s, feasibility of every limit, and complementarity (multiplier times distance to
/// its limit), the stationarity in x and the complementarity divided by max(1, |g|_inf). It is computed from
/// the problem alone, so it certifies the answer of any back end. Infinite when a number of the answer is not
/// finite.
double kkt_residual(const QpStructure& structure, const QpData& data, const QpResult& result);

/// Memory for an objective and a residual that are computed again and again.
struct KktWorkspace {
  explicit KktWorkspace(const QpStructure& structure);

  std::shared_ptr<const LaneProgram> lanes;
  bool own_slacks;                  ///< every row has a slack of its own, in the order of the rows
  std::vector<SlackRun> runs;       ///< if not own_slacks
  LaneVector row_value;             ///< m
  Eigen::VectorXd row_dual;         ///< m
  Eigen::VectorXd row_slack, pull;  ///< if not own_slacks: the slack of each row, m, and what pushes it, q
  std::vector<int> pushing;         ///< rows with a multiplier
  LaneVector stationarity;          ///< n; for the objective, Hx
};

/// The same two functions, with memory that the caller keeps: they allocate nothing.
double objective(const QpStructure& structure, const QpData& data, const QpResult& result,
                 KktWorkspace& workspace);
double kkt_residual(const QpStructure& structure, const QpData& data, const QpResult& result,
                    KktWorkspace& workspace);

}  // namespace mpm
