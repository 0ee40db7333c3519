#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "solvers/qp.hpp"

namespace mpm {

/// The vertex at which the last answer of a linear program lies. While its active limits stay the same, as
/// they mostly do from sample to sample, n equations give the next answer. N are the normals of these limits
/// (n x n), b are their values, and c is the gradient g with the prices l_q of the rows beyond a soft limit:
/// plus l_q a_i beyond the upper limit, minus l_q a_i beyond the lower one. Then
///
///     N x = b,    N' lambda = -c.
///
/// x is the only minimiser if the other limits are kept, rows beyond a soft limit stay there, and every
/// multiplier is on the side of its limit and, if that limit is soft, below the price (the simplex method's
/// test of a vertex, with strict complementarity).
class LinearVertex {
 public:
  /// Whether programs of this structure are linear, and each soft row has a slack of its own.
  static bool applies(const QpStructure& structure);

  /// `structure` must pass applies() and outlive this object.
  explicit LinearVertex(const QpStructure& structure);

  /// Takes the vertex of an answer; none if the answer is degenerate or one of several.
  void take(const QpData& data, const QpResult& answer);
  void forget() { active_.clear(); }

  /// Fills x, slack and multipliers of `result` if the vertex is the only minimiser; otherwise returns false.
  /// Allocates nothing.
  bool solve(const QpData& data, QpResult& result);

 private:
  enum class Limit { bound, hard, soft };
  struct Active {
    Limit limit;
    Eigen::Index index;  ///< of the variable or of the row
    bool upper;

    bool operator==(const Active&) const = default;
  };

  void find_active(const QpResult& answer, double margin);
  void factor();
  double price(Eigen::Index row) const { return structure_.slack_linear(structure_.slack_of_row(row)); }
  bool solve_equations(const QpData& data);
  bool multipliers_fit(double margin) const;
  bool limits_are_kept(const QpData& data) const;
  void report(const QpData& data, QpResult& result) const;

  const QpStructure& structure_;
  std::vector<Active> active_, found_;  ///< limits of the vertex, none or n, and those of an answer
  Eigen::VectorXi beyond_;  ///< of each row: 1 beyond its upper soft limit, -1 beyond its lower one
  Eigen::MatrixXd normals_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;      ///< of N
  Eigen::PartialPivLU<Eigen::MatrixXd> transposed_;  ///< of N'; factor_ would allocate to solve with N'
  Eigen::VectorXd place_, x_, cost_, multiplier_, row_value_;
};

}  // namespace mpm
