#include "scenarios/faults/fault.hpp"

#include <cassert>
#include <tuple>
#include <utility>
#include <variant>

#include "base/same_members.hpp"
#include "plants/linear/in_series.hpp"

namespace mpm {
namespace {

TransferFunction changed(const TransferFunction& channel, const Mismatch& mismatch) {
  switch (mismatch.parameter) {
    case MismatchParameter::gain:
      return channel.with_gain_scaled(mismatch.value);
    case MismatchParameter::time_constant:
      return channel.with_time_scaled(mismatch.value);
    case MismatchParameter::dead_time:
      return channel.with_dead_time_shifted(mismatch.value);
    case MismatchParameter::channel:
      assert(mismatch.channel);
      return *mismatch.channel;
    case MismatchParameter::second_order:
      return in_series(channel, TransferFunction::first_order(1.0, mismatch.value));
    case MismatchParameter::inverse_response:
      return in_series(channel, TransferFunction(Eigen::Vector2d(-mismatch.value, 1.0),
                                                 Eigen::Vector2d(mismatch.value, 1.0)));
    case MismatchParameter::sign:
      return channel.with_gain_scaled(mismatch.value);
  }
  return channel;
}

auto members(const Mismatch& mismatch) {
  const auto& [cv, input, parameter, value, channel] = mismatch;
  return std::tie(cv, input, parameter, value, channel);
}

auto members(const Disturbance& disturbance) {
  const auto& [cv, gain, time_constant, model, Gd, signal, inner_input, mv, shares_signal] = disturbance;
  return std::tie(cv, gain, time_constant, model, Gd, signal, inner_input, mv, shares_signal);
}

void scale(WhiteNoise& noise, double factor) {
  noise.factor *= factor;
}
void scale(Sine& sine, double factor) {
  sine.amplitude *= factor;
}
void scale(Ramp& ramp, double factor) {
  ramp.slope *= factor;
}
void scale(StepSequence& sequence, double factor) {
  for (StepSequence::Step& step : sequence.steps)
    step.level *= factor;
}
void scale(RandomWalk& walk, double factor) {
  walk.factor *= factor;
}
void scale(Bursts& bursts, double factor) {
  bursts.factor *= factor;
}

}  // namespace

DisturbanceSignal scaled(DisturbanceSignal signal, double factor) {
  std::visit([factor](auto& form) { scale(form, factor); }, signal);
  return signal;
}

TransferMatrix with_mismatches(TransferMatrix model, const std::vector<Mismatch>& mismatches) {
  TransferMatrix plant = std::move(model);
  for (const Mismatch& mismatch : mismatches) {
    TransferFunction& channel = plant(mismatch.cv, mismatch.input);
    channel = changed(channel, mismatch);
  }
  return plant;
}

ExperimentKind kind_of(const std::vector<Mismatch>& mismatches,
                       const std::vector<ParameterChange>& parameters,
                       const std::vector<Disturbance>& disturbances) {
  if (mismatches.empty() && parameters.empty())
    return disturbances.empty() ? ExperimentKind::healthy : ExperimentKind::ud;
  return disturbances.empty() ? ExperimentKind::mpm : ExperimentKind::mpm_ud;
}

FaultSource source_of(ExperimentKind kind) {
  switch (kind) {
    case ExperimentKind::mpm:
      return FaultSource::mpm;
    case ExperimentKind::ud:
      return FaultSource::ud;
    case ExperimentKind::mpm_ud:
      return FaultSource::mpm_ud;
    case ExperimentKind::other:
      return FaultSource::other;
    case ExperimentKind::healthy:
    case ExperimentKind::tuning:
      break;
  }
  return FaultSource::none;
}

bool operator==(const Mismatch& a, const Mismatch& b) {
  return same_members(members(a), members(b));
}

bool operator==(const Disturbance& a, const Disturbance& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
