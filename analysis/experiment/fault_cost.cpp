#include "analysis/experiment/fault_cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/statistics/ratio_of_means.hpp"
#include "analysis/statistics/variance.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/signals.hpp"
#include "solvers/mpc_objective.hpp"

namespace mpm {
namespace {

double outside(double y, double lower, double upper) {
  return std::max({0.0, y - upper, lower - y});
}

/// Sums over the pairs of one side of them.
struct Side {
  Eigen::VectorXd variance, loss, violation;
  std::vector<double> total;
  double effort = 0.0, economics = 0.0;

  explicit Side(Eigen::Index ny)
      : variance(Eigen::VectorXd::Zero(ny)),
        loss(Eigen::VectorXd::Zero(ny)),
        violation(Eigen::VectorXd::Zero(ny)) {}

  void add(const Study& study, const Trajectory& loop) {
    variance += variances(loop.y, variance_centres(study, 0, loop.y.cols()));
    const LoopCost cost = loop_cost(study, loop);
    loss += cost.cv;
    violation += cost.violation;
    effort += cost.effort;
    economics += cost.economics;
    total.push_back(cost.total());
  }
};

}  // namespace

LoopCost loop_cost(const Study& study, const Trajectory& loop) {
  const MpcOptions& controller = study.controller;
  const Eigen::Index ny = loop.y.rows(), N = loop.y.cols();
  LoopCost cost{.cv = Eigen::VectorXd::Zero(ny), .violation = Eigen::VectorXd::Zero(ny)};
  const auto weights = [&controller](const Eigen::VectorXd& of) {
    return effective_weight(of, controller.weight_convention);
  };
  const Eigen::VectorXd of_slack = weights(controller.slack_weight);
  const Eigen::VectorXd of_setpoint = weights(controller.setpoint_weight);
  const Eigen::VectorXd of_move = weights(controller.move_suppression);
  for (Eigen::Index k = 0; k < N; ++k) {
    const Limits soft = soft_limits(study, k);
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      const double violation = outside(loop.y(cv, k), soft.lower(cv), soft.upper(cv));
      cost.violation(cv) += violation;
      if (controller.has_soft_limit(cv))
        cost.cv(cv) += of_slack(cv) * violation * violation +
                       (controller.has_slack_cost(cv) ? controller.slack_cost(cv) * violation : 0.0);
      if (controller.has_setpoint(cv))
        cost.cv(cv) += of_setpoint(cv) * std::pow(loop.y(cv, k) - loop.y_set(cv, k), 2);
    }
    if (k > 0)
      cost.effort += of_move.dot((loop.u.col(k) - loop.u.col(k - 1)).cwiseAbs2());
    if (controller.mv_cost.size() > 0)
      cost.economics += controller.mv_cost.dot(loop.u.col(k));
  }
  const auto samples = static_cast<double>(N);
  return {cost.cv / samples, cost.violation / samples, cost.effort / samples, cost.economics / samples};
}

bool FaultCost::has_impact(double upper) const {
  return loss_ratio > upper || std::any_of(variance_ratio.begin(), variance_ratio.end(),
                                           [upper](double ratio) { return ratio > upper; });
}

std::int64_t pilot_noise(const Study& study, const ExperimentDraw& draw, int loops, int loop) {
  // Below those of the benchmarks.
  constexpr std::int64_t kFirst = -(std::int64_t{1} << 32);
  const int stride = study.world ? std::max(study.world->cost_loops, study.world->repair_loops) : loops;
  return kFirst - draw.index * std::max(stride, loops) - loop;
}

FaultCost fault_cost(const Study& study, const ExperimentDraw& draw, int pairs,
                     const QpSolverFactory& factory, SolverStatistics& pilots) {
  const Eigen::Index ny = study.cv_count();
  FaultCost cost{Eigen::VectorXd::Ones(ny), Eigen::VectorXd::Zero(ny), Eigen::VectorXd::Zero(ny)};
  if (is_faultless(draw.kind))
    return cost;
  const Study moved = with_excitation(study, draw.index);
  Side with(ny), without(ny);
  for (int pair = 0; pair < pairs; ++pair) {
    ExperimentDraw faulty = draw;
    faulty.noise_index = pilot_noise(study, draw, pairs, pair);
    const Trajectory a = simulate_experiment(moved, faulty, factory);
    const Trajectory b = simulate_experiment(moved, faulty.without_faults(), factory);
    pilots.add(a.solver);
    pilots.add(b.solver);
    if (a.status != ControlStatus::ok || b.status != ControlStatus::ok) {
      const Eigen::VectorXd none = Eigen::VectorXd::Constant(ny, kNaN);
      return {none, none, none, kNaN, kNaN, kNaN, kNaN};
    }
    with.add(moved, a);
    without.add(moved, b);
  }
  const double n = pairs;
  cost.variance_ratio = with.variance.cwiseQuotient(without.variance);
  cost.loss = (with.loss - without.loss) / n;
  cost.violation = (with.violation - without.violation) / n;
  cost.effort = (with.effort - without.effort) / n;
  cost.economics = (with.economics - without.economics) / n;
  const RatioOfMeans ratio = ratio_of_means(with.total, without.total);
  cost.loss_ratio = ratio.value;
  cost.error = ratio.error;
  return cost;
}

}  // namespace mpm
