#include "analysis/experiment/fault_cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/statistics/ratio_of_means.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

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
                     const QpSolverFactory& factory, SolverStatistics& pilots, PilotCosts* costs) {
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
  if (costs != nullptr)
    *costs = {std::move(with.total), std::move(without.total)};
  return cost;
}

}  // namespace mpm
