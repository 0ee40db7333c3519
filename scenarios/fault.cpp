#include "scenarios/fault.hpp"

#include <cassert>
#include <tuple>
#include <utility>

#include "plants/same_members.hpp"

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
  }
  return channel;
}

auto members(const Mismatch& mismatch) {
  const auto& [cv, input, parameter, value, channel] = mismatch;
  return std::tie(cv, input, parameter, value, channel);
}

auto members(const Disturbance& disturbance) {
  const auto& [cv, gain, time_constant, model, Gd, signal, inner_input] = disturbance;
  return std::tie(cv, gain, time_constant, model, Gd, signal, inner_input);
}

}  // namespace

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
    case ExperimentKind::healthy:
    case ExperimentKind::tuning:
      break;
  }
  return FaultSource::none;
}

std::string_view to_string(ExperimentKind kind) {
  switch (kind) {
    case ExperimentKind::healthy:
      return "healthy";
    case ExperimentKind::mpm:
      return "mpm";
    case ExperimentKind::ud:
      return "ud";
    case ExperimentKind::mpm_ud:
      return "mpm_ud";
    case ExperimentKind::tuning:
      return "tuning";
  }
  return "unknown";
}

std::string_view to_string(FaultSource source) {
  switch (source) {
    case FaultSource::none:
      return "none";
    case FaultSource::mpm:
      return "mpm";
    case FaultSource::ud:
      return "ud";
    case FaultSource::mpm_ud:
      return "mpm_ud";
  }
  return "unknown";
}

std::string_view to_string(MismatchParameter parameter) {
  switch (parameter) {
    case MismatchParameter::gain:
      return "gain";
    case MismatchParameter::time_constant:
      return "time_constant";
    case MismatchParameter::dead_time:
      return "dead_time";
    case MismatchParameter::channel:
      return "channel";
  }
  return "unknown";
}

bool operator==(const Mismatch& a, const Mismatch& b) {
  return same_members(members(a), members(b));
}

bool operator==(const Disturbance& a, const Disturbance& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
