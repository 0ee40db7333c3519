#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/transfer_matrix.hpp"
#include "solvers/mpc_objective.hpp"
#include "solvers/mpc_options.hpp"
#include "solvers/qp.hpp"

namespace mpm {

/// The problem of one sample as a QP in the planned MV positions relative to the last one,
/// x = (v(0), ..., v(Hc-1)), v(i) = u(k+i) - u(k-1), each of nu numbers:
///
///     move suppression + target tracking + setpoint tracking + sum_{j,l} tau_j delta_{j,l}^2
///
/// (solvers/mpc_objective), subject to the MV limits as bounds of x and the CV limits as rows y(k+l) =
/// free(k+l) + R x, l = 1..Hp. With a slack per CV, delta_{j,l} = delta_j and tau_j counts Hp times, as the
/// sum over the horizon in (6.20) says. A move limit bounds v(0) directly, and v(i) - v(i-1) by a row after
/// those of the CVs.
///
/// Hessian and rows are constant; gradient and limits are affine in (free response, u(k-1), u_target, y_set,
/// y(k)), except for the limits of v(0) where a move limit and an MV limit meet.
class MpcQp {
 public:
  /// `options` must be valid for the model (see MpcOptions::validate). Throws InputError if they do not
  /// determine the moves, because the Hessian is singular to rounding.
  MpcQp(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options);

  std::shared_ptr<const QpStructure> structure() const { return structure_; }

  /// The problem of one sample. Allocates nothing; the reference stays valid until the next call.
  const QpData& update(const MpcSample& sample);

  /// The problem of the last update.
  const QpData& data() const { return data_; }

  /// Replaces the limits of the CVs (ny each).
  void set_cv_limits(const Limits& hard, const Limits& soft) {
    cv_hard_ = hard;
    cv_soft_ = soft;
  }

  /// Sets the MVs that do not move: v_j(i) = 0 replaces their limits.
  void set_held(std::vector<Eigen::Index> mvs) { held_ = std::move(mvs); }

 private:
  MpcQp(RowMajorMatrix forced, Eigen::Index mv_count, const MpcOptions& options);

  Eigen::Index mv_count_;
  int prediction_horizon_;
  int control_horizon_;
  Limits mv_hard_, cv_hard_, cv_soft_;
  Eigen::VectorXd move_limit_;  ///< nu; infinite: none
  std::vector<Eigen::Index> held_;
  TargetTracking targets_;
  SetpointTracking setpoints_;
  std::shared_ptr<const QpStructure> structure_;
  QpData data_;
};

}  // namespace mpm
