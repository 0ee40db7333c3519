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
    : weight_(effective_weight(options.target_weight, options.weight_convention)) {
  const std::vector<int> starts = options.move_starts();
  for (std::size_t i = 0; i < starts.size(); ++i)
    samples_held_.push_back((i + 1 < starts.size() ? starts[i + 1] : options.prediction_horizon) - starts[i]);
}

void TargetTracking::add_hessian(Eigen::MatrixXd& hessian) const {
  Eigen::Index place = 0;
  for (const double held : samples_held_)
    for (const double weight : weight_) {
      hessian(place, place) += 2.0 * weight * held;
      ++place;
    }
}

void TargetTracking::add_gradient(const MpcSample& sample, Eigen::VectorXd& gradient) const {
  Eigen::Index place = 0;
  for (const double held : samples_held_)
    for (Eigen::Index j = 0; j < weight_.size(); ++j) {
      gradient(place) += -2.0 * held * weight_(j) * (sample.target(j) - sample.previous(j));
      ++place;
    }
}

namespace {

Eigen::VectorXd way_to_setpoint(const MpcOptions& options, Eigen::Index cv) {
  if (!options.has_reference(cv))
    return {};
  const Eigen::Index hp = options.prediction_horizon;
  const double rate = options.sample_time / options.reference_time(cv);
  return (-rate * Eigen::ArrayXd::LinSpaced(hp, 1.0, static_cast<double>(hp))).exp();
}

}  // namespace

SetpointTracking::SetpointTracking(const MpcOptions& options, const RowMajorMatrix& forced) {
  const Eigen::Index hp = options.prediction_horizon;
  const Eigen::VectorXd weight = effective_weight(options.setpoint_weight, options.weight_convention);
  for (Eigen::Index cv = 0; cv < weight.size(); ++cv)
    if (weight(cv) > 0.0)
      tracked_.push_back({cv, weight(cv), forced.middleRows(cv * hp, hp), way_to_setpoint(options, cv)});
}

void SetpointTracking::add_hessian(Eigen::MatrixXd& hessian) const {
  for (const TrackedCv& tracked : tracked_)
    hessian += 2.0 * tracked.weight * tracked.forced.transpose() * tracked.forced;
}

void SetpointTracking::add_gradient(const MpcSample& sample, Eigen::VectorXd& gradient) const {
  for (const TrackedCv& tracked : tracked_)
    for (Eigen::Index l = 0; l < tracked.forced.rows(); ++l) {
      double reference = sample.setpoint(tracked.cv);
      if (tracked.from_here.size() > 0)
        reference += tracked.from_here(l) * (sample.measured(tracked.cv) - reference);
      gradient.noalias() += (2.0 * tracked.weight * (sample.free(tracked.cv, l) - reference)) *
                            tracked.forced.row(l).transpose();
    }
}

}  // namespace mpm
