#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_problem.hpp"
#include "solvers/lanes/lane_vector.hpp"
#include "solvers/qp.hpp"

namespace mpm {

/// A family of limits of the dual active-set method; b' z is the limited quantity.
///
/// | kind        | limited                  | b                          |
/// |-------------|--------------------------|----------------------------|
/// | bound       | z_j                      | e_j                        |
/// | soft        | a_i x, eliminated slack  | (a_i, 0), softness 1/(2w)  |
/// | hard        | a_i x                    | (a_i, 0)                   |
/// | slack_upper | a_i x - s_q(i)           | (a_i, -e_q)                |
/// | slack_lower | a_i x + s_q(i)           | (a_i, +e_q)                |
enum class LimitKind { bound, soft, hard, slack_upper, slack_lower };

/// One side of one limit; `side` is +1 (upper) or -1 (lower).
struct LimitSide {
  LimitKind kind = LimitKind::bound;
  Eigen::Index index = 0;
  double side = 1.0;
};

/// The limits of one QP in the metric of Q = diag(H, 2w) + diag(sigma): products b' inv(Q) b, values,
/// distances.
class LimitGeometry {
 public:
  explicit LimitGeometry(const ActiveSetProblem& problem);

  /// b_1' inv(Q) b_2, plus the softness when both are the same limit.
  double product(const LimitSide& first, const LimitSide& second) const;

  /// The limit on this side, infinite when there is none.
  double limit(const QpData& data, const LimitSide& side) const;
  /// b' z.
  double value(const LimitSide& side, const LaneVector& z) const;
  /// 1/(2w) of an eliminated slack, else 0.
  double softness(const LimitSide& side) const;
  /// Subtracts the sum over the limits k of side_k factor_k b_k from `vector`.
  void subtract_normals(const std::vector<LimitSide>& sides, const Eigen::VectorXd& factor,
                        LaneVector& vector);

  /// Replaces `vector` by inv(Q) times it.
  void apply_inverse(LaneVector& vector);

 private:
  Eigen::Index slack_variable(const LimitSide& side) const;
  double slack_sign(const LimitSide& side) const;
  bool has_row(const LimitSide& side) const;

  const ActiveSetProblem& problem_;
  LaneMatrix lower_;             ///< L below its diagonal, H + diag(sigma) = L L'
  LaneVector inverse_, packed_;  ///< inverses of the blocks on the diagonal of L; scratch
  LaneMatrix scaled_;            ///< columns L^-1 a_i, then L^-1 e_j
  Eigen::VectorXd slack_;        ///< 2w + sigma of the kept slacks
  LaneVector force_;             ///< force on each row in `subtract_normals`, otherwise zero
  std::vector<int> pushing_;     ///< the rows with a force
};

}  // namespace mpm
