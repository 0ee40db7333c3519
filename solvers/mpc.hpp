#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "plants/linear_plant.hpp"
#include "plants/transfer_matrix.hpp"
#include "solvers/mpc_options.hpp"
#include "solvers/mpc_qp.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/target_optimizer.hpp"

namespace mpm {

enum class ControlStatus {
  ok,
  infeasible,  ///< no move keeps the hard limits of MVs and CVs over the horizon
  failed,      ///< the solver gave no answer
};

std::string_view to_string(ControlStatus status);

/// What the controller decided at one sample, and how well its problems were solved.
struct ControlMove {
  ControlStatus status = ControlStatus::ok;
  Eigen::VectorXd u;          ///< MVs to apply from this sample on, nu
  Eigen::VectorXd u_target;   ///< targets of the optimizer, nu
  double kkt_residual = 0.0;  ///< the larger of the two problems' residuals
  int iterations = 0;         ///< of the solver, both problems
  int fallbacks = 0;          ///< problems whose answer is Ipopt's, see CertifiedSolver
};

/// Model predictive control to setpoints, within ranges, or both, with a target optimizer above it where MVs
/// have targets (thesis 2.4, 3.3, 6.3, 6.4).
///
/// At sample k, from the measured CVs y(k) and MDs d(k):
/// 1. Output-bias feedback: b(k) = y(k) - y_sim(k), y_sim = G0 (u, d), is added to every prediction.
/// 2. The targets for the steady state K_d d(k) + b(k) + K u (6.19).
/// 3. The moves from the free response with MVs held at u(k-1) and MDs held at d(k) (6.20). Setpoints are
///    those of this sample, held over the horizon: the controller does not know their changes beforehand.
///
/// y(k) and d(k) are measured just before u(k) acts; d(k) acts from sample k on, as u(k) does.
///
/// | symbol | meaning                     | shape |
/// |--------|-----------------------------|-------|
/// | y, d   | measured CVs and MDs        | ny, nd|
/// | G0     | nominal model, MVs then MDs | ny x (nu + nd) |
class Mpc {
 public:
  /// Throws InputError when the options do not fit the model.
  Mpc(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options,
      const QpSolverFactory& factory);

  /// Starts from the steady state of MVs `u` (nu) and MDs `d` (nd), with no warm start. Throws InputError for
  /// a wrong size or a number that is not finite.
  void reset(const Eigen::Ref<const Eigen::VectorXd>& u, const Eigen::Ref<const Eigen::VectorXd>& d);

  /// The move of this sample; the model goes on with it at the next step, unless set_acting() is called. When
  /// the status is not `ok` the MVs stay where they are. The reference stays valid until the next call.
  /// Throws InputError for a wrong size or a number that is not finite.
  const ControlMove& step(const Eigen::Ref<const Eigen::VectorXd>& y,
                          const Eigen::Ref<const Eigen::VectorXd>& d);

  /// MVs that act from the last step on in place of those of its move, because something is added to them
  /// that the controller knows, such as a test signal. The model is advanced with them; the next move is
  /// still counted from the last one. Throws InputError as step().
  void set_acting(const Eigen::Ref<const Eigen::VectorXd>& u);

  /// The problems of the last step; there is no target problem without targets. When the targets have no
  /// answer, the moves are those of an earlier step.
  std::optional<SolvedQp> target_problem() const;
  SolvedQp move_problem() const { return {solver_->structure(), qp_.data(), solver_->result()}; }

  /// Replaces the soft limits of the CVs, in the MPC and in the target optimizer.
  void set_cv_soft(const Limits& limits);

  /// The setpoints from the next step on, in the MPC and in the target optimizer; ny numbers, of which those
  /// of CVs without a setpoint are not read. They are zero until this is called.
  void set_setpoints(const Eigen::Ref<const Eigen::VectorXd>& y_set);

  /// The MVs at which a loop starts: the targets for measured disturbances `d`, the setpoints as they are and
  /// no bias; without targets zero, the operating point of the model. Forgets the warm start of the target
  /// optimizer, so that the answer depends on its arguments alone.
  Eigen::VectorXd nominal_target(const Eigen::Ref<const Eigen::VectorXd>& d);

 private:
  void pass_on_limits();
  bool solve_targets();
  void solve_moves();

  Eigen::Index nu_;
  Eigen::MatrixXd md_gain_;
  LinearPlant model_, scratch_;
  MpcQp qp_;
  std::optional<TargetOptimizer> targets_;
  std::unique_ptr<QpSolver> solver_;
  Eigen::VectorXd input_;    ///< (u(k-1), d(k)), then what acts, (u(k), d(k))
  bool is_pending_ = false;  ///< input_ acts, and the model has not been advanced with it
  Eigen::VectorXd bias_, y_at_zero_, setpoint_;
  Eigen::VectorXd setpoint_weight_;
  Limits cv_soft_, target_range_;
  Eigen::MatrixXd free_;  ///< ny x Hp
  ControlMove move_;
};

}  // namespace mpm
