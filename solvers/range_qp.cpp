#include "solvers/range_qp.hpp"

#include "solvers/prediction.hpp"

namespace mpm {
namespace {

Eigen::VectorXd effective_weight(const Eigen::VectorXd& weight, WeightConvention convention) {
  return convention == WeightConvention::squared ? weight.cwiseAbs2().eval() : weight;
}

/// How many samples of the horizon hold planned position i: the last one is held to its end.
double samples_held(int i, int prediction_horizon, int control_horizon) {
  return i < control_horizon - 1 ? 1.0 : prediction_horizon - control_horizon + 1.0;
}

Eigen::MatrixXd move_hessian(const RangeMpcOptions& options, Eigen::Index nu) {
  const Eigen::VectorXd move = effective_weight(options.move_suppression, options.weight_convention);
  const Eigen::VectorXd target = effective_weight(options.target_weight, options.weight_convention);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(nu * options.control_horizon, nu * options.control_horizon);
  for (int i = 0; i < options.control_horizon; ++i)
    for (Eigen::Index j = 0; j < nu; ++j) {
      const Eigen::Index now = i * nu + j;
      hessian(now, now) +=
          2.0 * (move(j) + target(j) * samples_held(i, options.prediction_horizon, options.control_horizon));
      if (i == 0)
        continue;
      const Eigen::Index before = now - nu;
      hessian(before, before) += 2.0 * move(j);
      hessian(before, now) -= 2.0 * move(j);
      hessian(now, before) -= 2.0 * move(j);
    }
  return hessian;
}

}  // namespace

RangeQp::RangeQp(const TransferMatrix& model, Eigen::Index mv_count, const RangeMpcOptions& options)
    : mv_count_(mv_count),
      prediction_horizon_(options.prediction_horizon),
      control_horizon_(options.control_horizon),
      mv_hard_(options.mv_hard),
      cv_hard_(options.cv_hard),
      cv_soft_(options.cv_soft),
      target_weight_(effective_weight(options.target_weight, options.weight_convention)) {
  const Eigen::Index ny = model.rows();
  const int hp = options.prediction_horizon;
  auto structure = std::make_shared<QpStructure>();
  structure->hessian = move_hessian(options, mv_count);
  structure->rows = forced_response(model, mv_count, options.sample_time, hp, options.control_horizon);
  structure->slack_of_row.resize(ny * hp);
  const bool per_sample = options.slack_form == SlackForm::per_sample;
  structure->slack_quadratic.resize(per_sample ? ny * hp : ny);
  for (Eigen::Index cv = 0; cv < ny; ++cv)
    for (int l = 0; l < hp; ++l) {
      const Eigen::Index row = cv * hp + l;
      const Eigen::Index slack = per_sample ? row : cv;
      structure->slack_of_row(row) = static_cast<int>(slack);
      structure->slack_quadratic(slack) = options.slack_weight(cv) * (per_sample ? 1.0 : hp);
    }
  structure->slack_linear.setZero(structure->slack_quadratic.size());
  data_ = QpData::unconstrained(*structure);
  structure_ = std::move(structure);
}

const QpData& RangeQp::update(const Eigen::Ref<const Eigen::MatrixXd>& free,
                              const Eigen::Ref<const Eigen::VectorXd>& previous,
                              const Eigen::Ref<const Eigen::VectorXd>& target) {
  for (int i = 0; i < control_horizon_; ++i) {
    const double held = samples_held(i, prediction_horizon_, control_horizon_);
    for (Eigen::Index j = 0; j < mv_count_; ++j) {
      const Eigen::Index x = i * mv_count_ + j;
      data_.gradient(x) = -2.0 * held * target_weight_(j) * (target(j) - previous(j));
      data_.lower(x) = mv_hard_.lower(j) - previous(j);
      data_.upper(x) = mv_hard_.upper(j) - previous(j);
    }
  }
  for (Eigen::Index cv = 0; cv < free.rows(); ++cv)
    for (Eigen::Index l = 0; l < prediction_horizon_; ++l) {
      const Eigen::Index row = cv * prediction_horizon_ + l;
      data_.hard_lower(row) = cv_hard_.lower(cv) - free(cv, l);
      data_.hard_upper(row) = cv_hard_.upper(cv) - free(cv, l);
      data_.soft_lower(row) = cv_soft_.lower(cv) - free(cv, l);
      data_.soft_upper(row) = cv_soft_.upper(cv) - free(cv, l);
    }
  return data_;
}

}  // namespace mpm
