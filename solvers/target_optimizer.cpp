#include "solvers/target_optimizer.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

/// Largest slope of the objective without the penalty, within the limits of the MVs if they have any.
double largest_slope(const MpcOptions& options) {
  double largest = options.mv_cost.lpNorm<Eigen::Infinity>();
  for (Eigen::Index j = 0; options.has_resting_values() && j < options.resting_weight.size(); ++j)
    for (const double limit : {options.mv_hard.lower(j), options.mv_hard.upper(j)}) {
      const double way = std::isfinite(limit) ? limit - options.resting_value(j) : 1.0;
      largest =
          std::max(largest, std::abs(options.mv_cost(j)) + 2.0 * options.resting_weight(j) * std::abs(way));
    }
  return largest;
}

std::shared_ptr<const QpStructure> target_structure(const Eigen::MatrixXd& static_gain,
                                                    const MpcOptions& options) {
  const Eigen::Index ny = static_gain.rows();
  const Eigen::Index nu = static_gain.cols();
  const double largest_cost = largest_slope(options);
  auto structure = std::make_shared<QpStructure>();
  structure->hessian.setZero(nu, nu);
  if (options.has_resting_values())
    structure->hessian.diagonal() = 2.0 * options.resting_weight;
  structure->rows = static_gain;
  structure->slack_of_row.setLinSpaced(ny, 0, static_cast<int>(ny) - 1);
  structure->slack_quadratic.setZero(ny);
  structure->slack_linear.setConstant(
      ny, options.target_violation_cost * (largest_cost > 0.0 ? largest_cost : 1.0));
  return structure;
}

}  // namespace

TargetOptimizer::TargetOptimizer(const Eigen::MatrixXd& static_gain, const MpcOptions& options,
                                 const QpSolverFactory& factory)
    : mv_hard_(options.mv_hard), cv_soft_(options.cv_soft) {
  const auto structure = target_structure(static_gain, options);
  data_ = QpData::unconstrained(*structure);
  data_.gradient = options.mv_cost;
  if (options.has_resting_values())
    data_.gradient -= 2.0 * options.resting_weight.cwiseProduct(options.resting_value);
  data_.lower = options.mv_hard.lower;
  data_.upper = options.mv_hard.upper;
  solver_ = factory(structure);
}

void TargetOptimizer::set_held(const Eigen::Ref<const Eigen::VectorXd>& position) {
  data_.lower = position.array().isNaN().select(mv_hard_.lower, position);
  data_.upper = position.array().isNaN().select(mv_hard_.upper, position);
}

const QpResult& TargetOptimizer::solve(const Eigen::Ref<const Eigen::VectorXd>& y_at_zero) {
  data_.soft_lower = cv_soft_.lower - y_at_zero;
  data_.soft_upper = cv_soft_.upper - y_at_zero;
  return solver_->solve(data_);
}

}  // namespace mpm
