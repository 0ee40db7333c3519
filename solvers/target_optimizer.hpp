#pragma once

#include <memory>

#include <Eigen/Core>

#include "solvers/mpc_options.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The steady-state target optimizer above the MPC (6.19):
///
///     minimise    phi_u' u_tgt + sum_j w_u,j (u_tgt,j - r_u,j)^2 + rho sum_j v_j     over u_tgt, v >= 0
///     subject to  mv_hard.lower <= u_tgt <= mv_hard.upper
///                 cv_soft.lower - v <= y_0 + K u_tgt <= cv_soft.upper + v
///
/// where K is the static gain of the nominal model and y_0 the steady state of the CVs with the MVs at zero.
/// A CV that integrates enters with its rate, whose limits are 0 (Mpc). The thesis gives no answer for limits
/// that no target satisfies. Here the violation v has the price rho = target_violation_cost * the largest
/// slope of the objective within the limits, max|phi_u| without resting values: an exact penalty. Limits that
/// can be kept are kept (v = 0, the answer is that of (6.19)); otherwise the sum of the violations is made
/// small first. The resting values r_u of industrial controllers, with weights w_u, are not in the thesis;
/// there are none by default.
///
/// | symbol | meaning                    | shape   | unit    |
/// |--------|----------------------------|---------|---------|
/// | K      | static gains, MVs          | ny x nu | CV / MV |
/// | y_0    | steady state at MVs zero   | ny      | CV      |
/// | u_tgt  | MV targets                 | nu      | MV      |
class TargetOptimizer {
 public:
  /// Uses mv_hard, cv_soft, mv_cost, target_violation_cost and the resting values of `options`, which must be
  /// valid.
  TargetOptimizer(const Eigen::MatrixXd& static_gain, const MpcOptions& options,
                  const QpSolverFactory& factory);

  /// Finds the targets for the steady state `y_at_zero` (ny) of the CVs at zero MVs. The reference stays
  /// valid until the next call: result.x are the targets, result.slack the violations.
  const QpResult& solve(const Eigen::Ref<const Eigen::VectorXd>& y_at_zero);

  /// Replaces the soft limits of the CVs (ny each).
  void set_cv_soft(const Limits& limits) { cv_soft_ = limits; }

  /// Fixes targets at `position` (nu); NaN where the limits of the MV hold.
  void set_held(const Eigen::Ref<const Eigen::VectorXd>& position);

  void reset() { solver_->reset(); }

  /// The problem of the last solve.
  SolvedQp problem() const { return {solver_->structure(), data_, solver_->result()}; }

 private:
  Limits mv_hard_, cv_soft_;
  QpData data_;
  std::unique_ptr<QpSolver> solver_;
};

}  // namespace mpm
