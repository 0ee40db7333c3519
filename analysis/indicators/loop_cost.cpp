#include "analysis/indicators/loop_cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/non_finite.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/mpc_objective.hpp"

namespace mpm {
namespace {

double outside(double y, double lower, double upper) {
  return std::max({0.0, y - upper, lower - y});
}

}  // namespace

bool costs_by_setpoint(const Study& study, Eigen::Index cv, LevelCost levels) {
  const MpcOptions& controller = study.controller;
  return controller.has_setpoint(cv) && !(levels == LevelCost::in_range && study.plant.G.is_integrating(cv) &&
                                          controller.has_soft_limit(cv));
}

Eigen::VectorXd cv_costs(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                         const Eigen::Ref<const Eigen::MatrixXd>& y_set, Eigen::Index first,
                         LevelCost levels) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(y.rows()), count = sum;
  for (Eigen::Index k = first; k < y.cols(); ++k) {
    const Limits soft = soft_limits(study, k);
    for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
      if (is_off(study, VariableSort::cv, cv, k) || std::isnan(y(cv, k)))
        continue;
      const double off = costs_by_setpoint(study, cv, levels)
                             ? y(cv, k) - y_set(cv, k)
                             : outside(y(cv, k), soft.lower(cv), soft.upper(cv));
      sum(cv) += off * off;
      count(cv) += 1.0;
    }
  }
  return sum.cwiseQuotient(count);
}

Eigen::VectorXd cost_floor(const Study& study, LevelCost levels) {
  Eigen::VectorXd floor = study.simulation.noise_standard_deviation.cwiseAbs2();
  for (Eigen::Index cv = 0; cv < floor.size(); ++cv)
    if (costs_by_setpoint(study, cv, levels))
      floor(cv) = 0.0;
  return floor;
}

Eigen::VectorXd counted_costs(const Study& study, const Trajectory& loop, const std::vector<bool>& counted) {
  Eigen::MatrixXd y = loop.y;
  for (Eigen::Index k = 0; k < y.cols(); ++k)
    if (!counted[static_cast<std::size_t>(k)])
      y.col(k).setConstant(kNaN);
  return cv_costs(study, y, setpoints(study), 0, LevelCost::in_range) +
         cost_floor(study, LevelCost::in_range);
}

LoopCost loop_cost(const Study& study, const Trajectory& loop, const std::vector<bool>& counted) {
  const MpcOptions& controller = study.controller;
  const Eigen::Index ny = loop.y.rows(), N = loop.y.cols();
  LoopCost cost{.cv = Eigen::VectorXd::Zero(ny), .violation = Eigen::VectorXd::Zero(ny)};
  const auto weights = [&controller](const Eigen::VectorXd& of) {
    return effective_weight(of, controller.weight_convention);
  };
  const Eigen::VectorXd of_slack = weights(controller.slack_weight);
  const Eigen::VectorXd of_setpoint = weights(controller.setpoint_weight);
  const Eigen::VectorXd of_move = weights(controller.move_suppression);
  double samples = 0.0;
  for (Eigen::Index k = 0; k < N; ++k) {
    if (!counted.empty() && !counted[static_cast<std::size_t>(k)])
      continue;
    samples += 1.0;
    const Limits soft = soft_limits(study, k);
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      const double violation = outside(loop.y(cv, k), soft.lower(cv), soft.upper(cv));
      cost.violation(cv) += violation;
      if (controller.has_soft_limit(cv))
        cost.cv(cv) += of_slack(cv) * violation * violation +
                       (controller.has_slack_cost(cv) ? controller.slack_cost(cv) * violation : 0.0);
      if (controller.has_setpoint(cv) && !is_off(study, VariableSort::cv, cv, k))
        cost.cv(cv) += of_setpoint(cv) * std::pow(loop.y(cv, k) - loop.y_set(cv, k), 2);
    }
    if (k > 0)
      cost.effort += of_move.dot((loop.u.col(k) - loop.u.col(k - 1)).cwiseAbs2());
    if (controller.mv_cost.size() > 0)
      cost.economics += controller.mv_cost.dot(loop.u.col(k));
  }
  return {cost.cv / samples, cost.violation / samples, cost.effort / samples, cost.economics / samples};
}

}  // namespace mpm
