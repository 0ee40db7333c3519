#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "solvers/lanes/lane_program.hpp"
#include "solvers/lanes/lane_vector.hpp"
#include "solvers/qp.hpp"

namespace mpm {

/// The constant part of a QP in the form in which the active-set method uses it (docs/active_set.md).
///
/// A slack that belongs to one row and has quadratic cost only is eliminated, which leaves the penalty w
/// dist(a_i x, [soft_lower_i, soft_upper_i])^2. Every other slack stays a variable, so that the variables are
/// z = (x, s), where s are the kept slacks.
///
/// | symbol  | member             | shape | meaning                                                       |
/// |---------|--------------------|-------|---------------------------------------------------------------|
/// | Q       | quadratic          | N x N | H, and 2 w_q of the kept slacks, on the diagonal blocks       |
/// | sigma_j | proximal           | N     | proximal weight where Q alone may not determine z_j, else 0   |
/// | c_s     | kept slack_linear  | N - n | linear costs of the kept slacks                               |
/// |         | slack_column       | m     | index in z of the kept slack of row i, -1: none               |
/// |         | softness           | m     | 2 w of the eliminated slack of row i, 0: none                 |
/// |         | limit_stiffness    | m     | penalty of the method of multipliers on a limit of row i      |
/// | H, A    | lanes              |       | for the kernels                                               |
struct ActiveSetProblem {
  explicit ActiveSetProblem(const QpStructure& structure);
  /// The same with the `lanes` of the structure, which others use as well.
  ActiveSetProblem(const QpStructure& structure, std::shared_ptr<const LaneProgram> lanes);

  Eigen::Index variable_count() const { return quadratic.rows(); }
  /// The normal b = (a_row, slack_sign at the kept slack of the row) of a limit, N numbers.
  void write_normal(int row, double slack_sign, LaneVector& normal) const;
  /// True when some z_j needs the proximal term: the minimiser of Q alone is not unique or does not exist.
  bool needs_proximal() const { return proximal.size() > 0 && proximal.maxCoeff() > 0; }

  const QpStructure* structure;
  Eigen::MatrixXd quadratic;
  Eigen::VectorXd proximal;
  std::vector<int> kept_slacks;  ///< index q of each kept slack
  Eigen::VectorXi slack_column;
  Eigen::VectorXd softness;
  Eigen::VectorXd limit_stiffness;
  std::shared_ptr<const LaneProgram> lanes;
};

}  // namespace mpm
