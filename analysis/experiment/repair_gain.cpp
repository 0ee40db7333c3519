#include "analysis/experiment/repair_gain.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "analysis/experiment/repaired_model.hpp"
#include "analysis/statistics/ratio_of_means.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/excitation.hpp"

namespace mpm {
namespace {

/// A gain is one beyond chance when it is above so many of its standard errors.
constexpr double kErrors = 2.0;

/// The costs of the loops of one experiment under a model, loop by loop; empty when one does not run to its
/// end.
class RepairLoops {
 public:
  RepairLoops(const Study& study, int loops, const QpSolverFactory& factory, SolverStatistics& pilots)
      : study_(study), loops_(loops), factory_(factory), pilots_(pilots) {}

  std::vector<double> costs(const TransferMatrix& model, const ExperimentDraw& draw,
                            const std::vector<double>& known = {}) const {
    if (const auto n = static_cast<std::size_t>(loops_); known.size() >= n)
      return {known.begin(), known.begin() + loops_};
    std::vector<double> costs;
    for (int loop = 0; loop < loops_; ++loop) {
      ExperimentDraw noisy = draw;
      noisy.noise_index = pilot_noise(study_, draw, loops_, loop);
      const Trajectory run = loop_with_model(study_, model, noisy, factory_);
      pilots_.add(run.solver);
      if (run.status != ControlStatus::ok)
        return {};
      costs.push_back(loop_cost(study_, run).total());
    }
    return costs;
  }

 private:
  const Study& study_;
  int loops_;
  const QpSolverFactory& factory_;
  SolverStatistics& pilots_;
};

/// Of the repair after which the loops cost `after`.
RatioOfMeans gain_of(const std::vector<double>& now, const std::vector<double>& after,
                     const std::vector<double>& without) {
  if (after.empty())
    return {kNaN, kNaN};
  std::vector<double> saved;
  for (std::size_t loop = 0; loop < now.size(); ++loop)
    saved.push_back(now[loop] - after[loop]);
  return ratio_of_means(saved, without);
}

}  // namespace

std::optional<double> RepairGains::best() const {
  std::optional<double> best;
  for (Eigen::Index i = 0; i < gain.size(); ++i)
    if (const double each = gain.data()[i]; each > 0.0 && each > kErrors * error.data()[i])
      best = std::max(best.value_or(each), each);
  return best;
}

double RepairGains::share_of(const std::optional<Channel>& channel) const {
  if (!channel)
    return 0.0;
  const double found = gain(channel->cv, channel->mv);
  return found > 0.0 ? std::min(1.0, found / best().value()) : 0.0;  // not that of a NaN
}

RepairGains repair_gains(const Study& study, const ExperimentDraw& draw, int loops,
                         const QpSolverFactory& factory, SolverStatistics& pilots, const PilotCosts& known) {
  if (draw.mismatches.empty() || study.nonlinear || loops == 0)
    return {};
  const Study moved = with_excitation(study, draw.index);
  const RepairLoops runs(moved, loops, factory, pilots);
  const bool same_loops = draw.onset.from_the_start() && !draw.tuning;
  const std::vector<double> now =
      runs.costs(moved.plant.G, draw, same_loops ? known.with : std::vector<double>());
  const std::vector<double> without = runs.costs(moved.plant.G, draw.without_faults(), known.without);
  if (now.empty() || without.empty())
    return {};
  const TransferMatrix plant = true_plant(moved, draw);
  RepairGains gains{Eigen::MatrixXd::Zero(plant.rows(), plant.cols()),
                    Eigen::MatrixXd::Zero(plant.rows(), plant.cols())};
  for (Eigen::Index cv = 0; cv < plant.rows(); ++cv)
    for (Eigen::Index input = 0; input < plant.cols(); ++input) {
      if (plant(cv, input) == moved.plant.G(cv, input))
        continue;
      TransferMatrix repaired = moved.plant.G;
      repaired(cv, input) = plant(cv, input);
      const RatioOfMeans gain = gain_of(now, runs.costs(repaired, draw), without);
      gains.gain(cv, input) = gain.value;
      gains.error(cv, input) = gain.error;
    }
  return gains;
}

}  // namespace mpm
