#include "scenarios/draw.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "scenarios/random_stream.hpp"

namespace mpm {
namespace {

using Channel = std::pair<Eigen::Index, Eigen::Index>;

std::vector<Channel> mv_channels(const Study& study) {
  std::vector<Channel> channels;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
      if (!study.plant.G(cv, mv).is_zero())
        channels.emplace_back(cv, mv);
  if (channels.empty())
    throw InputError("plant", "no channel from an MV to a CV", "at least one");
  return channels;
}

/// A place drawn with these relative frequencies.
std::size_t draw_place(std::span<const double> weights, RandomStream& stream) {
  const double point = stream.uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    if (point < sum)
      return i;
    if (weights[i] > 0.0)
      last = i;
  }
  return last;  // by rounding only
}

// A dead time cannot become negative: a bounded distribution is shrunk onto what is possible, so that the
// draw still gives a mismatch; an unbounded one is cut off.
double possible_shift(double shift, const Distribution& distribution, double dead_time) {
  if (distribution.minimum() >= -dead_time)
    return shift;
  const double span = distribution.maximum() - distribution.minimum();
  if (!std::isfinite(span) || span == 0.0 || distribution.maximum() <= -dead_time)
    return std::max(shift, -dead_time);
  const double quantile = (shift - distribution.minimum()) / span;
  return -dead_time + quantile * (distribution.maximum() + dead_time);
}

Mismatch draw_mismatch(const Study& study, std::int64_t index) {
  RandomStream stream(study.seed, static_cast<std::uint64_t>(index), StreamId::mismatch);
  const std::vector<Channel> channels = mv_channels(study);
  const auto [cv, mv] = channels[stream.below(channels.size())];
  const MismatchRanges& ranges = study.mismatch;
  const auto parameter = static_cast<MismatchParameter>(draw_place(ranges.parameter_weight, stream));
  double value = 0.0;
  switch (parameter) {
    case MismatchParameter::gain:
      value = ranges.gain_factor.sample(stream);
      break;
    case MismatchParameter::time_constant:
      value = ranges.time_constant_factor.sample(stream);
      break;
    case MismatchParameter::dead_time:
      value = possible_shift(ranges.dead_time_shift.sample(stream), ranges.dead_time_shift,
                             study.plant.G(cv, mv).dead_time());
      break;
    case MismatchParameter::channel:
      assert(false);  // is never drawn
      break;
  }
  return {cv, mv, parameter, value};
}

Disturbance draw_disturbance(const Study& study, std::int64_t index) {
  RandomStream stream(study.seed, static_cast<std::uint64_t>(index), StreamId::disturbance_draw);
  const auto cv = static_cast<Eigen::Index>(stream.below(static_cast<std::uint64_t>(study.cv_count())));
  const double gain = study.disturbance.gain.sample(stream);
  const double time_constant = study.disturbance.time_constant.sample(stream);
  return {cv, gain, time_constant};
}

TuningChange draw_tuning(const Study& study, std::int64_t index) {
  RandomStream stream(study.seed, static_cast<std::uint64_t>(index), StreamId::tuning);
  const std::array<double, 4> weights = study.tuning.weights_for(study.controller);
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; }))
    throw InputError("tuning.parameter_weights", "a weight of 0 for everything that the controller has",
                     "at least one > 0");
  const TuningParameter parameter = kTuningParameters[draw_place(weights, stream)];
  const std::vector<Eigen::Index> variables = variables_with(study.controller, parameter);
  const Eigen::Index variable = variables[stream.below(variables.size())];
  return {parameter, variable, study.tuning.factor.sample(stream)};
}

ExperimentDraw named_experiment(const Study& study, std::int64_t index) {
  if (index >= study.experiment_count())
    throw InputError("experiment index", fmt::format("{}", index),
                     fmt::format("0 to {}, the named scenarios of the study", study.experiment_count() - 1));
  const Scenario& scenario = study.scenarios[static_cast<std::size_t>(index)];
  return {index,
          kind_of(scenario.mismatches, scenario.parameters, scenario.disturbances),
          scenario.mismatches,
          scenario.disturbances,
          true,
          scenario.affected_cvs,
          scenario.parameters};
}

}  // namespace

std::vector<AffectedCv> ExperimentDraw::affected() const {
  std::map<Eigen::Index, std::pair<bool, bool>> faults;  // CV -> mismatch, disturbance
  for (const Mismatch& mismatch : mismatches)
    faults[mismatch.cv].first = true;
  for (const Disturbance& disturbance : disturbances)
    if (!disturbance.inner_input)
      faults[disturbance.cv].second = true;
  if (affected_cvs) {
    const auto own = std::exchange(faults, {});
    for (const Eigen::Index cv : *affected_cvs)
      faults[cv] = own.contains(cv)
                       ? own.at(cv)
                       : std::pair(!mismatches.empty() || !parameters.empty(), !disturbances.empty());
  }
  std::vector<AffectedCv> list;
  for (const auto& [cv, fault] : faults)
    list.push_back({cv, fault.first && fault.second ? FaultSource::mpm_ud
                        : fault.first               ? FaultSource::mpm
                                                    : FaultSource::ud});
  return list;
}

Eigen::Index ExperimentDraw::true_cv() const {
  const std::vector<AffectedCv> list = affected();
  return list.size() == 1 ? list.front().cv : -1;
}

ExperimentDraw ExperimentDraw::mismatch_alone() const {
  ExperimentDraw alone = *this;
  alone.disturbances.clear();
  alone.kind = kind_of(alone.mismatches, alone.parameters, alone.disturbances);
  return alone;
}

ExperimentDraw ExperimentDraw::disturbance_alone() const {
  ExperimentDraw alone = *this;
  alone.mismatches.clear();
  alone.parameters.clear();
  alone.kind = kind_of(alone.mismatches, alone.parameters, alone.disturbances);
  return alone;
}

KindSequence::KindSequence(const ExperimentCounts& counts) {
  // A kind without experiments is never behind, so that adding one to the list changes no other study.
  constexpr std::array kinds{ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud,
                             ExperimentKind::healthy, ExperimentKind::tuning};
  std::array<std::pair<ExperimentKind, int>, kinds.size()> wanted;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    wanted[k] = {kinds[k], counts.of(kinds[k])};
  for (const auto& [kind, count] : wanted)
    if (count < 0)
      throw InputError("experiments", fmt::format("{}", count), "counts >= 0");
  if (counts.total() == 0)
    throw InputError("experiments", "no experiment at all", "at least one");

  int divisor = 0;
  for (const auto& [kind, count] : wanted)
    divisor = std::gcd(divisor, count);
  const int length = counts.total() / divisor;
  std::array<int, kinds.size()> placed{};
  for (int i = 0; i < length; ++i) {
    // The kind that is furthest behind its share of the first i + 1 experiments; ties go in order of kind.
    std::size_t next = 0;
    std::array<std::int64_t, kinds.size()> behind{};
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      behind[k] = std::int64_t{wanted[k].second / divisor} * (i + 1) - std::int64_t{placed[k]} * length;
      if (behind[k] > behind[next])
        next = k;
    }
    ++placed[next];
    period_.push_back(wanted[next].first);
  }
}

ExperimentKind KindSequence::operator[](std::int64_t index) const {
  return period_[static_cast<std::size_t>(index) % period_.size()];
}

ExperimentDraw draw_experiment(const Study& study, std::int64_t index) {
  if (index < 0)
    throw InputError("experiment index", fmt::format("{}", index), ">= 0");
  if (study.names_scenarios())
    return named_experiment(study, index);
  ExperimentDraw draw;
  draw.index = index;
  draw.kind = KindSequence(study.experiments)[index];
  const bool both = draw.kind == ExperimentKind::mpm_ud;
  if (draw.kind == ExperimentKind::mpm || both)
    draw.mismatches = {draw_mismatch(study, index)};
  if (draw.kind == ExperimentKind::ud || both)
    draw.disturbances = {draw_disturbance(study, index)};
  if (both)
    draw.disturbances.front().cv = draw.mismatches.front().cv;
  if (draw.kind == ExperimentKind::tuning)
    draw.tuning = draw_tuning(study, index);
  return draw;
}

ExperimentDraw basis_draw() {
  ExperimentDraw draw;
  draw.index = kBasisIndex;
  return draw;
}

Study with_tuning(const Study& study, const ExperimentDraw& draw) {
  Study changed = study;
  if (draw.tuning)
    changed.controller = with_tuning(std::move(changed.controller), *draw.tuning);
  return changed;
}

}  // namespace mpm
