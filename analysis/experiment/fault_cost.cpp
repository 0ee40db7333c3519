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

/// Sums over one loop of each pair: the loops with the fault, or those without it.
struct Side {
  Eigen::VectorXd variance, loss, violation;
  std::vector<double> total;
  std::vector<std::vector<double>> cv_cost;  ///< of each CV, pair by pair
  double effort = 0.0, economics = 0.0;

  explicit Side(Eigen::Index ny)
      : variance(Eigen::VectorXd::Zero(ny)),
        loss(Eigen::VectorXd::Zero(ny)),
        violation(Eigen::VectorXd::Zero(ny)),
        cv_cost(static_cast<std::size_t>(ny)) {}

  void add(const Study& study, const Trajectory& loop, Eigen::Index onset) {
    const Eigen::VectorXd of_cvs = cv_costs(study, loop.y, loop.y_set, onset) + cost_floor(study);
    for (Eigen::Index cv = 0; cv < of_cvs.size(); ++cv)
      cv_cost[static_cast<std::size_t>(cv)].push_back(of_cvs(cv));
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

bool FaultCost::has_impact(double upper, ImpactMeasure measure) const {
  const Eigen::VectorXd& ratios = measure == ImpactMeasure::cost ? cost_ratio : variance_ratio;
  return loss_ratio > upper ||
         std::any_of(ratios.begin(), ratios.end(), [upper](double ratio) { return ratio > upper; });
}

std::int64_t pilot_noise(const Study& study, const ExperimentDraw& draw, int loops, int loop) {
  // Below the indices of the benchmarks of worlds.
  constexpr std::int64_t kFirst = -(std::int64_t{1} << 32);
  const int stride = study.world ? std::max(study.world->cost_loops, study.world->repair_loops) : loops;
  return kFirst - draw.index * std::max(stride, loops) - loop;
}

FaultCost fault_cost(const Study& study, const ExperimentDraw& draw, int pairs,
                     const QpSolverFactory& factory, SolverStatistics& pilots, PilotCosts* costs) {
  const Eigen::Index ny = study.cv_count();
  FaultCost cost{.variance_ratio = Eigen::VectorXd::Ones(ny),
                 .loss = Eigen::VectorXd::Zero(ny),
                 .violation = Eigen::VectorXd::Zero(ny),
                 .cost_ratio = Eigen::VectorXd::Ones(ny),
                 .cost_ratio_error = Eigen::VectorXd::Zero(ny)};
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
      return {none, none, none, kNaN, kNaN, kNaN, kNaN, none, none};
    }
    with.add(moved, a, draw.onset.sample);
    without.add(moved, b, draw.onset.sample);
  }
  const double n = pairs;
  cost.variance_ratio = with.variance.cwiseQuotient(without.variance);
  cost.loss = (with.loss - without.loss) / n;
  cost.violation = (with.violation - without.violation) / n;
  cost.effort = (with.effort - without.effort) / n;
  cost.economics = (with.economics - without.economics) / n;
  const RatioOfMeans ratio = ratio_of_means(with.total, without.total);
  for (Eigen::Index cv = 0; cv < ny; ++cv) {
    const auto place = static_cast<std::size_t>(cv);
    const RatioOfMeans of_cv = ratio_of_means(with.cv_cost[place], without.cv_cost[place]);
    cost.cost_ratio(cv) = of_cv.value;
    cost.cost_ratio_error(cv) = of_cv.error;
  }
  cost.loss_ratio = ratio.value;
  cost.error = ratio.error;
  if (costs != nullptr)
    *costs = {std::move(with.total), std::move(without.total)};
  return cost;
}

}  // namespace mpm
