#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/linear_plant.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "solvers/controller.hpp"
#include "solvers/late_measurements.hpp"
#include "solvers/mpc_options.hpp"
#include "solvers/mpc_qp.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/target_optimizer.hpp"

namespace mpm {

/// Model predictive control to setpoints, within ranges, or both, with a target optimizer above it where MVs
/// have targets (thesis 2.4, 3.3, 6.3, 6.4).
///
/// At sample k, from the measured CVs y(k) and MDs d(k):
/// 1. Output-bias feedback: b(k) = y(k) - y_sim(k), y_sim = G0 (u, d), is added to every prediction. For a CV
///    of an analyser, y_sim is taken at the sample of the analysis; MDs that are measured late act in it from
///    the time of their measurement (LateMeasurements). The bias of a CV that integrates may have a
///    ramp, r(k) = r(k-1) + alpha (b(k) - b(k-1) - r(k-1)), because unknown flows act on a level all the
///    time. Its prediction l samples ahead then adds b(k) + l r(k).
/// 2. The targets for the steady state K_d d(k) + b(k) + K u (6.19). A CV that integrates is at a steady
///    state if its rate is 0: K_d and K are then the gains of the rate, and r replaces b. A rate is weighted
///    by the change that it makes to the CV over the prediction horizon.
/// 3. The moves from the free response with MVs held at u(k-1) and MDs held at d(k) (6.20). Setpoints are
///    those of this sample, held over the horizon: the controller does not know their changes beforehand.
///
/// An MV that is off (SwitchedOff) is an input that the model knows: it stays where it is held in both
/// problems, whose structures do not change. A CV that is off has no limits in either problem; if it has a
/// setpoint, the moves come from a second program without it.
///
/// | symbol | meaning                     | shape |
/// |--------|-----------------------------|-------|
/// | G0     | nominal model, MVs then MDs | ny x (nu + nd) |
class Mpc final : public Controller {
 public:
  /// Throws InputError when the options do not fit the model.
  Mpc(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options,
      const QpSolverFactory& factory);

  void reset(const Eigen::Ref<const Eigen::VectorXd>& u, const Eigen::Ref<const Eigen::VectorXd>& d) override;
  const ControlMove& step(const Eigen::Ref<const Eigen::VectorXd>& y,
                          const Eigen::Ref<const Eigen::VectorXd>& d) override;
  /// The model is advanced with these MVs; the next move is still counted from the last one.
  void set_acting(const Eigen::Ref<const Eigen::VectorXd>& u) override;
  /// Applies to the MPC and to the target optimizer, as set_setpoints() does.
  void set_cv_soft(const Limits& limits) override;
  /// Makes a new program the first time that exactly these CVs with a setpoint are off. A solver forgets its
  /// warm start when its program is taken up again.
  void set_off(const SwitchedOff& off) override;
  void set_setpoints(const Eigen::Ref<const Eigen::VectorXd>& y_set) override;
  /// Forgets the warm start of the target optimizer.
  Eigen::VectorXd nominal_target(const Eigen::Ref<const Eigen::VectorXd>& d) override;
  std::optional<SolvedQp> target_problem() const override;
  std::optional<SolvedQp> move_problem() const override;
  std::string failure() const override;

 private:
  /// The moves of one sample, as a problem and its solver.
  struct Program {
    MpcQp qp;
    std::unique_ptr<QpSolver> solver;
  };

  Program& program_without(const SwitchedOff& off);
  void pass_on_limits();
  void pass_on_targets();
  void feed_back(const Eigen::Ref<const Eigen::VectorXd>& y);
  void note(const QpResult& answer);
  bool solve_targets();
  void solve_moves();

  const TransferMatrix G_;
  const MpcOptions options_;
  const QpSolverFactory factory_;
  Eigen::Index nu_;
  std::vector<Eigen::Index> integrating_;  ///< CVs
  Eigen::MatrixXd md_gain_;  ///< steady-state gains; for a CV that integrates, over the prediction horizon
  LinearPlant model_, scratch_;
  std::optional<LateMeasurements> late_;
  std::map<std::vector<bool>, Program> programs_;  ///< by the CVs with a setpoint that are off
  Program* program_ = nullptr;
  std::optional<TargetOptimizer> targets_;
  Eigen::VectorXd input_;  ///< (u(k-1), d(k)), and after the move what acts, (u(k), d(k))
  AnalyserHold simulated_analysers_;
  bool is_pending_ = false;  ///< input_ acts, and the model has not been advanced with it
  bool has_bias_ = false;    ///< since reset()
  Eigen::VectorXd bias_, ramp_, ramp_share_, y_at_zero_, setpoint_, measured_, y_model_;
  Limits cv_soft_, target_range_;
  SwitchedOff off_;
  Eigen::MatrixXd free_;  ///< ny x Hp
  ControlMove move_;
  QpStatus reason_ = QpStatus::solved;  ///< of move_.status
};

}  // namespace mpm
