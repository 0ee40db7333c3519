#include "solvers/mpc_qp.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/prediction.hpp"

namespace mpm {
namespace {

/// If the quotient of the smallest and largest eigenvalue of the Hessian is below this, the moves are
/// rounding noise.
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
  structure.slack_of_row.setConstant(structure.rows.rows(), -1);
  structure.slack_linear.setZero(per_sample ? cv_count * hp : cv_count);
  structure.slack_quadratic.resize(per_sample ? cv_count * hp : cv_count);
  for (Eigen::Index cv = 0; cv < cv_count; ++cv) {
    const double weight = options.has_soft_limit(cv) ? options.slack_weight(cv) : 1.0;
    const double cost =
        options.has_soft_limit(cv) && options.has_slack_cost(cv) ? options.slack_cost(cv) : 0.0;
    const double uses = per_sample ? 1.0 : hp;
    for (int l = 0; l < hp; ++l) {
      const Eigen::Index row = cv * hp + l;
      const Eigen::Index slack = per_sample ? row : cv;
      structure.slack_of_row(row) = static_cast<int>(slack);
      structure.slack_quadratic(slack) = weight * uses;
      structure.slack_linear(slack) = cost * uses;
    }
  }
}

/// Adds a row v_j(i) - v_j(i-1), i = 1 ... Hc-1, for each MV with a limit of its moves.
void add_move_rows(const MpcOptions& options, RowMajorMatrix& rows) {
  if (!options.has_move_limits())
    return;
  const Eigen::Index nu = options.move_limit.size();
  for (Eigen::Index place = nu; place < rows.cols(); ++place) {
    if (!std::isfinite(options.move_limit(place % nu)))
      continue;
    rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
    rows.bottomRows(1).setZero();
    rows(rows.rows() - 1, place) = 1.0;
    rows(rows.rows() - 1, place - nu) = -1.0;
  }
}

std::shared_ptr<const QpStructure> make_structure(const MpcOptions& options, RowMajorMatrix forced,
                                                  const TargetTracking& targets,
                                                  const SetpointTracking& setpoints) {
  auto structure = std::make_shared<QpStructure>();
  const Eigen::Index cv_count = forced.rows() / options.prediction_horizon;
  structure->rows = std::move(forced);
  structure->hessian.setZero(structure->rows.cols(), structure->rows.cols());
  MoveSuppression(options).add_hessian(structure->hessian);
  targets.add_hessian(structure->hessian);
  setpoints.add_hessian(structure->hessian);
  require_determined(structure->hessian);
  add_move_rows(options, structure->rows);
  set_slacks(options, cv_count, *structure);
  return structure;
}

RowMajorMatrix forced(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options) {
  return forced_response(model, mv_count, options.sample_time, options.prediction_horizon,
                         options.move_starts());
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
      move_limit_(options.has_move_limits() ? options.move_limit
                                            : Eigen::VectorXd::Constant(mv_count, kInfinity)),
      targets_(options),
      setpoints_(options, forced),
      structure_(make_structure(options, std::move(forced), targets_, setpoints_)),
      data_(QpData::unconstrained(*structure_)) {
  Eigen::Index row = cv_soft_.lower.size() * prediction_horizon_;
  for (Eigen::Index place = mv_count; row < structure_->row_count(); ++place)
    if (const double limit = move_limit_(place % mv_count); std::isfinite(limit)) {
      data_.hard_lower(row) = -limit;
      data_.hard_upper(row) = limit;
      ++row;
    }
}

const QpData& MpcQp::update(const MpcSample& sample) {
  data_.gradient.setZero();
  targets_.add_gradient(sample, data_.gradient);
  setpoints_.add_gradient(sample, data_.gradient);
  for (int i = 0; i < control_horizon_; ++i) {
    data_.lower.segment(i * mv_count_, mv_count_) = mv_hard_.lower - sample.previous;
    data_.upper.segment(i * mv_count_, mv_count_) = mv_hard_.upper - sample.previous;
  }
  // An MV outside of its limits returns as fast as its move limit allows.
  data_.lower.head(mv_count_) = data_.lower.head(mv_count_).cwiseMax(-move_limit_).cwiseMin(move_limit_);
  data_.upper.head(mv_count_) = data_.upper.head(mv_count_).cwiseMin(move_limit_).cwiseMax(-move_limit_);
  for (const Eigen::Index mv : held_)
    for (int i = 0; i < control_horizon_; ++i)
      data_.lower(i * mv_count_ + mv) = data_.upper(i * mv_count_ + mv) = 0.0;
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
