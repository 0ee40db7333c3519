#pragma once

#include <memory>

#include <Eigen/Core>

#include "plants/transfer_matrix.hpp"
#include "solvers/qp.hpp"
#include "solvers/range_mpc_options.hpp"

namespace mpm {

/// The range MPC problem (6.20) as a QP in the planned MV positions relative to the last one,
/// x = (v(0), ..., v(Hc-1)), v(i) = u(k+i) - u(k-1), each of nu numbers:
///
///     sum_{i=0}^{Hp-1} [ w_du |v(i) - v(i-1)|^2 + w_u |v(i) - t|^2 ] + sum_{j,l} tau_j delta_{j,l}^2,
///     v(-1) = 0,  v(i) = v(Hc-1) for i >= Hc,  t = u_target - u(k-1),
///
/// subject to the MV limits as bounds of x and the CV limits as rows y(k+l) = free(k+l) + R x, l = 1..Hp. The
/// weights w follow the weight convention of the options. With a slack per CV, delta_{j,l} = delta_j and
/// tau_j counts Hp times, as the sum over the horizon says.
///
/// Hessian and rows are constant; gradient and limits are affine in (free response, u(k-1), u_target).
class RangeQp {
 public:
  /// `options` must be valid for the model (see RangeMpcOptions::validate).
  RangeQp(const TransferMatrix& model, Eigen::Index mv_count, const RangeMpcOptions& options);

  std::shared_ptr<const QpStructure> structure() const { return structure_; }

  /// The problem of one sample. Allocates nothing; the reference stays valid until the next call.
  /// `free` is ny x Hp with the output bias included; `previous` and `target` have nu numbers.
  const QpData& update(const Eigen::Ref<const Eigen::MatrixXd>& free,
                       const Eigen::Ref<const Eigen::VectorXd>& previous,
                       const Eigen::Ref<const Eigen::VectorXd>& target);

  /// The problem of the last update.
  const QpData& data() const { return data_; }

  /// Replaces the soft limits of the CVs (ny each).
  void set_cv_soft(const Limits& limits) { cv_soft_ = limits; }

 private:
  Eigen::Index mv_count_;
  int prediction_horizon_;
  int control_horizon_;
  Limits mv_hard_, cv_hard_, cv_soft_;
  Eigen::VectorXd target_weight_;  ///< in the convention of the options
  std::shared_ptr<const QpStructure> structure_;
  QpData data_;
};

}  // namespace mpm
