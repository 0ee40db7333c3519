#include "solvers/mpc_qp.hpp"

#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "plants/error.hpp"
#include "solvers/prediction.hpp"

namespace mpm {
namespace {

/// Below this quotient of the eigenvalues of the Hessian the moves are noise of the arithmetic.
constexpr double kSmallestReciprocalCondition = 1e-13;

void require_determined(const Eigen::MatrixXd& hessian) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(hessian, Eigen::EigenvaluesOnly);
  const double quotient = eigen.eigenvalues()(0) / eigen.eigenvalues()(hessian.rows() - 1);
  if (!(quotient > kSmallestReciprocalCondition))
    throw InputError("weights of the controller",
                     fmt::format("a Hessian with eigenvalues in the ratio {:.1e}", quotient),
                     "weights that determine every move (a move_suppression above 0 does)");
}

/// Slack weights count once a sample; a CV without soft limits has no slack that could become positive.
void set_slacks(const MpcOptions& options, Eigen::Index cv_count, QpStructure& structure) {
  const int hp = options.prediction_horizon;
  const bool per_sample = options.slack_form == SlackForm::per_sample;
  structure.slack_of_row.resize(cv_count * hp);
  structure.slack_quadratic.resize(per_sample ? cv_count * hp : cv_count);
  for (Eigen::Index cv = 0; cv < cv_count; ++cv) {
    const double weight = options.has_soft_limit(cv) ? options.slack_weight(cv) : 1.0;
    for (int l = 0; l < hp; ++l) {
      const Eigen::Index row = cv * hp + l;
      const Eigen::Index slack = per_sample ? row : cv;
      structure.slack_of_row(row) = static_cast<int>(slack);
      structure.slack_quadratic(slack) = weight * (per_sample ? 1.0 : hp);
    }
  }
  structure.slack_linear.setZero(structure.slack_quadratic.size());
}

std::shared_ptr<const QpStructure> make_structure(const MpcOptions& options, RowMajorMatrix forced,
                                                  const TargetTracking& targets,
                                                  const SetpointTracking& setpoints) {
  auto structure = std::make_shared<QpStructure>();
  structure->rows = std::move(forced);
  structure->hessian.setZero(structure->rows.cols(), structure->rows.cols());
  MoveSuppression(options).add_hessian(structure->hessian);
  targets.add_hessian(structure->hessian);
  setpoints.add_hessian(structure->hessian);
  require_determined(structure->hessian);
  set_slacks(options, structure->rows.rows() / options.prediction_horizon, *structure);
  return structure;
}

RowMajorMatrix forced(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options) {
  return forced_response(model, mv_count, options.sample_time, options.prediction_horizon,
                         options.control_horizon);
}

}  // namespace

MpcQp::MpcQp(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options)
    : MpcQp(forced(model, mv_count, options), mv_count, options) {}

MpcQp::MpcQp(RowMajorMatrix forced, Eigen::Index mv_count, const MpcOptions& options)
    : mv_count_(mv_count),
      prediction_horizon_(options.prediction_horizon),
      control_horizon_(options.control_horizon),
      mv_hard_(options.mv_hard),
      cv_hard_(options.cv_hard),
      cv_soft_(options.cv_soft),
      targets_(options),
      setpoints_(options, forced),
      structure_(make_structure(options, std::move(forced), targets_, setpoints_)),
      data_(QpData::unconstrained(*structure_)) {}

const QpData& MpcQp::update(const MpcSample& sample) {
  data_.gradient.setZero();
  targets_.add_gradient(sample, data_.gradient);
  setpoints_.add_gradient(sample, data_.gradient);
  for (int i = 0; i < control_horizon_; ++i) {
    data_.lower.segment(i * mv_count_, mv_count_) = mv_hard_.lower - sample.previous;
    data_.upper.segment(i * mv_count_, mv_count_) = mv_hard_.upper - sample.previous;
  }
  for (Eigen::Index cv = 0; cv < sample.free.rows(); ++cv)
    for (Eigen::Index l = 0; l < prediction_horizon_; ++l) {
      const Eigen::Index row = cv * prediction_horizon_ + l;
      data_.hard_lower(row) = cv_hard_.lower(cv) - sample.free(cv, l);
      data_.hard_upper(row) = cv_hard_.upper(cv) - sample.free(cv, l);
      data_.soft_lower(row) = cv_soft_.lower(cv) - sample.free(cv, l);
      data_.soft_upper(row) = cv_soft_.upper(cv) - sample.free(cv, l);
    }
  return data_;
}

}  // namespace mpm
