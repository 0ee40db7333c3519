#include "scenarios/draw.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>
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

MismatchParameter draw_parameter(const std::array<double, 3>& weight, RandomStream& stream) {
  const double point = stream.uniform() * (weight[0] + weight[1] + weight[2]);
  if (point < weight[0])
    return MismatchParameter::gain;
  if (point < weight[0] + weight[1])
    return MismatchParameter::time_constant;
  return MismatchParameter::dead_time;
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
  const MismatchParameter parameter = draw_parameter(ranges.parameter_weight, stream);
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
    list.push_back({cv, fault.first && fault.second ? ExperimentKind::mpm_ud
                        : fault.first               ? ExperimentKind::mpm
                                                    : ExperimentKind::ud});
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
  const std::array<std::pair<ExperimentKind, int>, 3> wanted{{{ExperimentKind::mpm, counts.mpm},
                                                              {ExperimentKind::ud, counts.ud},
                                                              {ExperimentKind::mpm_ud, counts.mpm_ud}}};
  for (const auto& [kind, count] : wanted)
    if (count < 0)
      throw InputError("experiments", fmt::format("{}", count), "counts >= 0");
  if (counts.total() == 0)
    throw InputError("experiments", "no experiment at all", "at least one");

  const int divisor = std::gcd(std::gcd(counts.mpm, counts.ud), counts.mpm_ud);
  const int length = counts.total() / divisor;
  std::array<int, 3> placed{};
  for (int i = 0; i < length; ++i) {
    // The kind that is furthest behind its share of the first i + 1 experiments; ties go in order of kind.
    std::size_t next = 0;
    std::array<std::int64_t, 3> behind{};
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
  if (draw.kind != ExperimentKind::ud)
    draw.mismatches = {draw_mismatch(study, index)};
  if (draw.kind != ExperimentKind::mpm)
    draw.disturbances = {draw_disturbance(study, index)};
  if (draw.kind == ExperimentKind::mpm_ud)
    draw.disturbances.front().cv = draw.mismatches.front().cv;
  return draw;
}

ExperimentDraw basis_draw() {
  ExperimentDraw draw;
  draw.index = kBasisIndex;
  return draw;
}

}  // namespace mpm
