#include "solvers/mpc_objective.hpp"

namespace mpm {

Eigen::VectorXd effective_weight(const Eigen::VectorXd& weight, WeightConvention convention) {
  return convention == WeightConvention::squared ? weight.cwiseAbs2().eval() : weight;
}

MoveSuppression::MoveSuppression(const MpcOptions& options)
    : control_horizon_(options.control_horizon),
      weight_(effective_weight(options.move_suppression, options.weight_convention)) {}

void MoveSuppression::add_hessian(Eigen::MatrixXd& hessian) const {
  const Eigen::Index nu = weight_.size();
  for (int i = 0; i < control_horizon_; ++i)
    for (Eigen::Index j = 0; j < nu; ++j) {
      const Eigen::Index now = i * nu + j;
      hessian(now, now) += 2.0 * weight_(j);
      if (i == 0)
        continue;
      const Eigen::Index before = now - nu;
      hessian(before, before) += 2.0 * weight_(j);
      hessian(before, now) -= 2.0 * weight_(j);
      hessian(now, before) -= 2.0 * weight_(j);
    }
}

TargetTracking::TargetTracking(const MpcOptions& options)
    : prediction_horizon_(options.prediction_horizon),
      control_horizon_(options.control_horizon),
      weight_(effective_weight(options.target_weight, options.weight_convention)) {}

/// How many samples of the horizon hold planned position i: the last one is held to its end.
double TargetTracking::samples_held(int i) const {
  return i < control_horizon_ - 1 ? 1.0 : prediction_horizon_ - control_horizon_ + 1.0;
}

void TargetTracking::add_hessian(Eigen::MatrixXd& hessian) const {
  const Eigen::Index nu = weight_.size();
  for (int i = 0; i < control_horizon_; ++i)
    for (Eigen::Index j = 0; j < nu; ++j)
      hessian(i * nu + j, i * nu + j) += 2.0 * weight_(j) * samples_held(i);
}

void TargetTracking::add_gradient(const MpcSample& sample, Eigen::VectorXd& gradient) const {
  const Eigen::Index nu = weight_.size();
  for (int i = 0; i < control_horizon_; ++i)
    for (Eigen::Index j = 0; j < nu; ++j)
      gradient(i * nu + j) += -2.0 * samples_held(i) * weight_(j) * (sample.target(j) - sample.previous(j));
}

SetpointTracking::SetpointTracking(const MpcOptions& options, const RowMajorMatrix& forced) {
  const Eigen::Index hp = options.prediction_horizon;
  const Eigen::VectorXd weight = effective_weight(options.setpoint_weight, options.weight_convention);
  for (Eigen::Index cv = 0; cv < weight.size(); ++cv)
    if (weight(cv) > 0.0)
      tracked_.push_back({cv, weight(cv), forced.middleRows(cv * hp, hp)});
}

void SetpointTracking::add_hessian(Eigen::MatrixXd& hessian) const {
  for (const TrackedCv& tracked : tracked_)
    hessian += 2.0 * tracked.weight * tracked.forced.transpose() * tracked.forced;
}

void SetpointTracking::add_gradient(const MpcSample& sample, Eigen::VectorXd& gradient) const {
  for (const TrackedCv& tracked : tracked_)
    for (Eigen::Index l = 0; l < tracked.forced.rows(); ++l)
      gradient.noalias() +=
          (2.0 * tracked.weight * (sample.free(tracked.cv, l) - sample.setpoint(tracked.cv))) *
          tracked.forced.row(l).transpose();
}

}  // namespace mpm
