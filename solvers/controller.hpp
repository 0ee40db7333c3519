#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "solvers/mpc_options.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/switched_off.hpp"

namespace mpm {

enum class ControlStatus {
  ok,
  infeasible,  ///< no move keeps the hard limits of MVs and CVs over the horizon
  failed,      ///< the solver, or the program that is the controller, gave no answer
};

std::string_view to_string(ControlStatus status);

/// What the controller decided at one sample, and how well its problems were solved.
struct ControlMove {
  ControlStatus status = ControlStatus::ok;
  Eigen::VectorXd u;          ///< MVs to apply from this sample on, nu
  Eigen::VectorXd u_target;   ///< targets of the optimizer, nu
  double kkt_residual = 0.0;  ///< the larger of the two problems' residuals
  int iterations = 0;         ///< of the solver, both problems
  int fallbacks = 0;          ///< problems that Ipopt answered, see CertifiedSolver
};

/// Decides on the MVs of a loop: the Mpc of this program, or a controller from outside. y(k) and d(k)
/// are measured just before u(k) acts; d(k) acts from sample k on, as u(k) does.
///
/// | symbol | meaning                     | shape |
/// |--------|-----------------------------|-------|
/// | y, d   | measured CVs and MDs        | ny, nd|
/// | u      | MVs                         | nu    |
class Controller {
 public:
  Controller() = default;
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;
  virtual ~Controller() = default;

  /// Starts from the steady state of MVs `u` (nu) and MDs `d` (nd) and forgets what was before. Throws
  /// InputError for a wrong size or a number that is not finite.
  virtual void reset(const Eigen::Ref<const Eigen::VectorXd>& u,
                     const Eigen::Ref<const Eigen::VectorXd>& d) = 0;

  /// The move of this sample, which acts unless set_acting() is called. When the status is not `ok` the MVs
  /// stay where they are. The reference stays valid until the next call. Throws InputError as reset().
  virtual const ControlMove& step(const Eigen::Ref<const Eigen::VectorXd>& y,
                                  const Eigen::Ref<const Eigen::VectorXd>& d) = 0;

  /// Sets the MVs that act from the last step on instead of those of its move, because something that the
  /// controller knows, such as a test signal, is added to them. Throws InputError as reset().
  virtual void set_acting(const Eigen::Ref<const Eigen::VectorXd>& u) = 0;

  /// Replaces the soft limits of the CVs from the next step on.
  virtual void set_cv_soft(const Limits& limits) = 0;

  /// Sets the variables that operators have switched off, from the next step on until the next call; none at
  /// first. An MV that is off is held at a position and acts as a measured disturbance does: its moves and
  /// targets are this position, and the next move is counted from there. A CV that is off affects only the
  /// output bias. Throws InputError for what SwitchedOff::validate() refuses, and if the remaining CVs do not
  /// determine the moves (MpcQp).
  virtual void set_off(const SwitchedOff& off) = 0;

  /// Sets the setpoints from the next step on: ny numbers, of which those of CVs without a setpoint are not
  /// read. They are zero until the first call.
  virtual void set_setpoints(const Eigen::Ref<const Eigen::VectorXd>& y_set) = 0;

  /// The MVs at which a loop starts: the economic optimum (6.19) for measured disturbances `d`, with the
  /// setpoints as they are and no bias. Without targets they are zero, the operating point of the model. They
  /// do not depend on earlier steps.
  virtual Eigen::VectorXd nominal_target(const Eigen::Ref<const Eigen::VectorXd>& d) = 0;

  /// The problems of the last step, to be solved again. A controller that does not pose its problems here has
  /// none, and without targets there is no target problem. If the targets have no answer, the move problem is
  /// that of an earlier step.
  virtual std::optional<SolvedQp> target_problem() const { return std::nullopt; }
  virtual std::optional<SolvedQp> move_problem() const { return std::nullopt; }

  /// Tells people why the status of the last move is `failed`.
  virtual std::string failure() const { return "the solver gave no answer"; }
};

}  // namespace mpm
