#include "analysis/methods/ours/repair_prospects.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/indicators/loop_cost.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/statistics/washout.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

constexpr std::uint64_t kDrawSeed = 43;
/// Part of the mean square of a CV below which the error of a channel is not worth a simulation.
constexpr double kFaintShare = 1e-3;
/// The largest ratio of the cost of a CV in the loop of a drawn plant to its cost in the record with which
/// the plant may have made the record. It is above 1 because the controller of a record is not quite that of
/// the study. Chosen on the records under the seeds 83 and 84 (tests/reliability/records.py).
constexpr double kMostUnlike = 2.0;

}  // namespace

/// The record, and what it says about the model of each CV.
struct RepairProspects::Seen {
  const AssessedLoop& whole;
  const std::vector<bool>& counted;
  Eigen::MatrixXd inputs;
  std::vector<ModelErrors> models = {};

  const ModelErrors& of(Eigen::Index cv) const { return models[static_cast<std::size_t>(cv)]; }
};

struct RepairProspects::Outcome {
  double cost;
  Eigen::VectorXd variances;
};

/// A plant that may have made the record, and what it leaves of the record.
struct RepairProspects::DrawnPlant {
  TransferMatrix plant;
  Eigen::MatrixXd left;
};

double RepairProspect::gain() const {
  if (gains.empty())
    return kNaN;
  double mean = 0.0;
  for (const double each : gains)
    mean += each / static_cast<double>(gains.size());
  return mean;
}

double RepairProspect::probability_above(double worth) const {
  if (gains.empty())
    return kNaN;
  double above = 0.0;
  for (const double each : gains)
    above += each > worth ? 1.0 / static_cast<double>(gains.size()) : 0.0;
  return above;
}

bool RepairProspect::is_proposed() const {
  return gain() > 0.0 && variance_ratio.maxCoeff() <= kNoticeableChange;
}

RepairProspects::RepairProspects(const Study& study, const OperatingPoint& point, ForEachWithSolver for_each)
    : study_(study),
      options_(study.assessment.of<AdequacyOptions>()),
      initial_(Eigen::VectorXd::Zero(study.plant.G.cols())),
      for_each_(std::move(for_each)) {
  initial_.head(point.u.size()) = point.u;
}

std::optional<std::vector<RepairProspect>> RepairProspects::of(const AssessedLoop& loop,
                                                               const std::optional<RepairedChannel>& given,
                                                               const std::vector<bool>& counted) const {
  const AssessedLoop& whole = loop.from_start();
  Seen seen{.whole = whole, .counted = counted, .inputs = model_inputs(whole)};
  for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv) {
    const Eigen::RowVectorXd e = errors_in_window(loop, cv);
    if ((!e.array().isNaN()).count() < kFewestNoiseSamples)
      return std::nullopt;
    seen.models.emplace_back(study_, cv,
                             relative_errors(study_, cv, options_.deviation, study_.assessment.bias), e,
                             seen.inputs, initial_, least_noise(whole.y_sim.row(cv)));
  }
  std::vector<RepairProspect> prospects = candidates(seen, given);
  if (!prospects.empty())
    run(seen, prospects);
  return prospects;
}

std::vector<RepairProspect> RepairProspects::candidates(const Seen& seen,
                                                        const std::optional<RepairedChannel>& given) const {
  struct Weighed {
    RepairedChannel repair;
    double share;
  };
  std::vector<Weighed> all;
  const Eigen::MatrixXd y = gaps_closed(seen.whole.y);
  for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
      const TransferFunction model = study_.assessed_channel(cv, mv);
      const TransferFunction& found = seen.of(cv).model()(0, mv);
      if (model.is_zero() || model == found || (given && given->channel == Channel{cv, mv}))
        continue;
      const double share =
          (response(seen, found, mv) - response(seen, model, mv)).squaredNorm() / y.row(cv).squaredNorm();
      if (share > kFaintShare)
        all.push_back({{{cv, mv}, found.without_washout()}, share});
    }
  std::stable_sort(all.begin(), all.end(),
                   [](const Weighed& a, const Weighed& b) { return a.share > b.share; });
  std::vector<RepairProspect> prospects;
  if (given)
    prospects.push_back({.repair = *given, .gains = {}});
  for (const Weighed& each : all)
    if (static_cast<int>(prospects.size()) < options_.channels)
      prospects.push_back({.repair = each.repair, .gains = {}});
  return prospects;
}

Eigen::RowVectorXd RepairProspects::response(const Seen& seen, const TransferFunction& channel,
                                             Eigen::Index input) const {
  return channel_response(discretise(channel, study_.controller.sample_time), seen.inputs.row(input),
                          initial_(input));
}

RepairProspects::DrawnPlant RepairProspects::drawn(const Seen& seen, RandomStream& random) const {
  TransferMatrix plant = study_.plant.G;
  Eigen::MatrixXd left = seen.whole.y;
  for (Eigen::Index cv = 0; cv < plant.rows(); ++cv) {
    const ModelErrors& model = seen.of(cv);
    Eigen::VectorXd z(model.count());
    for (double& each : z)
      each = random.normal();
    const TransferMatrix drawn = model.drawn(z);
    for (Eigen::Index input = 0; input < plant.cols(); ++input) {
      plant(cv, input) = drawn(0, input).without_washout();
      if (!drawn(0, input).is_zero())
        left.row(cv) -= response(seen, drawn(0, input), input);
    }
  }
  return {std::move(plant), from_washout(study_, left)};
}

std::vector<std::optional<RepairProspects::Outcome>> RepairProspects::outcomes(
    const Seen& seen, const DrawnPlant& drawn, const std::vector<RepairProspect>& prospects,
    const QpSolverFactory& factory) const {
  std::vector<std::optional<Outcome>> all{outcome(study_.plant.G, drawn.plant, seen, drawn.left, factory)};
  if (!all.front() || !may_have_made(seen, *all.front()))
    return {};
  for (const RepairProspect& prospect : prospects) {
    TransferMatrix repaired = study_.plant.G;
    repaired(prospect.repair.channel.cv, prospect.repair.channel.mv) = prospect.repair.model;
    all.push_back(outcome(repaired, drawn.plant, seen, drawn.left, factory));
  }
  return all;
}

void RepairProspects::run(const Seen& seen, std::vector<RepairProspect>& prospects) const {
  RandomStream random(kDrawSeed, 0, StreamId::world);
  std::vector<DrawnPlant> plants;
  for (int draw = 0; draw < options_.draws; ++draw)
    plants.push_back(drawn(seen, random));
  std::vector<std::vector<std::optional<Outcome>>> of_plants(plants.size());
  for_each_(plants.size(), [&](std::size_t draw, const QpSolverFactory& factory) {
    of_plants[draw] = outcomes(seen, plants[draw], prospects, factory);
  });
  for (std::size_t i = 0; i < prospects.size(); ++i) {
    Eigen::VectorXd before = Eigen::VectorXd::Zero(study_.cv_count()), after = before;
    for (const std::vector<std::optional<Outcome>>& loops : of_plants) {
      if (loops.empty() || !loops[i + 1])
        continue;
      const Outcome &now = *loops.front(), &then = *loops[i + 1];
      const double gain = (now.cost - then.cost) / now.cost;
      if (!std::isfinite(gain))
        continue;
      prospects[i].gains.push_back(gain);
      before += now.variances;
      after += then.variances;
    }
    std::sort(prospects[i].gains.begin(), prospects[i].gains.end());
    prospects[i].variance_ratio = after.array() / before.array();
  }
}

std::optional<RepairProspects::Outcome> RepairProspects::outcome(const TransferMatrix& model,
                                                                 const TransferMatrix& plant,
                                                                 const Seen& seen,
                                                                 const Eigen::MatrixXd& disturbance,
                                                                 const QpSolverFactory& factory) const {
  Study study = study_;
  study.plant.G = model;
  const Trajectory loop =
      run_closed_loop(study, plant,
                      {.d = seen.whole.d,
                       .noise = Eigen::MatrixXd::Zero(disturbance.rows(), disturbance.cols()),
                       .y_d = disturbance,
                       .y_set = setpoints(study_),
                       .dither = dither(study_)},
                      factory);
  if (loop.status != ControlStatus::ok)
    return std::nullopt;
  return Outcome{loop_cost(study_, loop, seen.counted).total(),
                 seen.counted.empty() ? variances(loop.y, variance_centres(study_, 0, loop.y.cols()))
                                      : counted_costs(study_, loop, seen.counted)};
}

bool RepairProspects::may_have_made(const Seen& seen, const Outcome& now) const {
  if (seen.counted.empty())
    return true;
  Trajectory recorded;
  recorded.y = gaps_closed(seen.whole.y);
  return !(now.variances.array() > kMostUnlike * counted_costs(study_, recorded, seen.counted).array()).any();
}

std::vector<RepairProspect> ranked(std::vector<RepairProspect> prospects) {
  std::stable_sort(prospects.begin(), prospects.end(), [](const RepairProspect& a, const RepairProspect& b) {
    return !a.gains.empty() && (b.gains.empty() || a.gain() > b.gain());
  });
  return prospects;
}

const RepairProspect* prospect_of(const std::vector<RepairProspect>& prospects, const Channel& channel) {
  for (const RepairProspect& prospect : prospects)
    if (prospect.repair.channel == channel && !prospect.gains.empty())
      return &prospect;
  return nullptr;
}

}  // namespace mpm
