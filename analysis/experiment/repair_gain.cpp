#include "analysis/experiment/repair_gain.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <vector>

#include "analysis/experiment/repaired_model.hpp"
#include "analysis/statistics/ratio_of_means.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/excitation.hpp"

namespace mpm {
namespace {

/// A gain is beyond chance if it is above this many of its standard errors.
constexpr double kErrors = 2.0;

/// The costs of the loops of one experiment under a model, loop by loop.
class RepairLoops {
 public:
  RepairLoops(const Study& study, int loops, const QpSolverFactory& factory, SolverStatistics& pilots)
      : study_(study), loops_(loops), factory_(factory), pilots_(pilots) {}

  int count() const { return loops_; }

  /// Runs those of the first `count` loops that `costs` lacks; empties `costs` if one does not run to its
  /// end.
  void run(std::vector<double>& costs, int count, const TransferMatrix& model,
           const ExperimentDraw& draw) const {
    for (int loop = static_cast<int>(costs.size()); loop < count; ++loop) {
      ExperimentDraw noisy = draw;
      noisy.noise_index = pilot_noise(study_, draw, loops_, loop);
      const Trajectory run = loop_with_model(study_, model, noisy, factory_);
      pilots_.add(run.solver);
      if (run.status != ControlStatus::ok) {
        costs.clear();
        return;
      }
      costs.push_back(loop_cost(study_, run).total());
    }
  }

  /// The costs of all loops; `known` are the costs of loops that have been run, all or none.
  std::vector<double> costs(const TransferMatrix& model, const ExperimentDraw& draw,
                            const std::vector<double>& known) const {
    const auto n = static_cast<std::ptrdiff_t>(loops_);
    std::vector<double> costs;
    if (std::ssize(known) >= n)
      costs.assign(known.begin(), known.begin() + n);
    run(costs, loops_, model, draw);
    return costs;
  }

 private:
  const Study& study_;
  int loops_;
  const QpSolverFactory& factory_;
  SolverStatistics& pilots_;
};

/// A channel, and the costs of the loops under a model in which it is right.
struct Repair {
  Channel channel;
  TransferMatrix model;
  std::vector<double> costs = {};
};

/// The gain of the repair after which the first loops cost `after`.
RatioOfMeans gain_of(const std::vector<double>& now, const std::vector<double>& after,
                     const std::vector<double>& without) {
  if (after.empty())
    return {kNaN, kNaN};
  std::vector<double> saved;
  for (std::size_t loop = 0; loop < after.size(); ++loop)
    saved.push_back(now[loop] - after[loop]);
  return ratio_of_means(saved, {without.begin(), without.begin() + std::ssize(after)});
}

/// The repairs of all channels in which the plant differs from the model.
std::vector<Repair> repairs_of(const TransferMatrix& model, const TransferMatrix& plant) {
  std::vector<Repair> repairs;
  for (Eigen::Index cv = 0; cv < plant.rows(); ++cv)
    for (Eigen::Index input = 0; input < plant.cols(); ++input)
      if (plant(cv, input) != model(cv, input)) {
        repairs.push_back({{cv, input}, model});
        repairs.back().model(cv, input) = plant(cv, input);
      }
  return repairs;
}

/// Runs the first loop of each repair, and the other loops of the repairs whose gain in it is at least
/// `screen` times the largest gain.
void run_repairs(std::vector<Repair>& repairs, const RepairLoops& runs, const ExperimentDraw& draw,
                 double screen, const std::function<double(const Repair&)>& gain) {
  double most = -kInfinity;
  for (Repair& repair : repairs) {
    runs.run(repair.costs, 1, repair.model, draw);
    if (!repair.costs.empty())
      most = std::max(most, gain(repair));
  }
  const double least = screen == 0.0 ? -kInfinity : std::min(most, screen * most);
  for (Repair& repair : repairs)
    if (!repair.costs.empty() && gain(repair) >= least)
      runs.run(repair.costs, runs.count(), repair.model, draw);
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
  return found > 0.0 ? std::min(1.0, found / best().value()) : 0.0;  // 0 for a NaN, too
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
  std::vector<Repair> repairs = repairs_of(moved.plant.G, plant);
  run_repairs(repairs, runs, draw, moved.world ? moved.world->repair_screen : 0.0,
              [&](const Repair& repair) { return gain_of(now, repair.costs, without).value; });
  RepairGains gains{Eigen::MatrixXd::Zero(plant.rows(), plant.cols()),
                    Eigen::MatrixXd::Zero(plant.rows(), plant.cols())};
  for (const Repair& repair : repairs) {
    const RatioOfMeans gain = gain_of(now, repair.costs, without);
    gains.gain(repair.channel.cv, repair.channel.mv) = gain.value;
    gains.error(repair.channel.cv, repair.channel.mv) = gain.error;
  }
  return gains;
}

}  // namespace mpm
