#include "scenarios/study.hpp"

#include <tuple>

#include "plants/same_members.hpp"

namespace mpm {
namespace {

auto members(const SimulationOptions& options) {
  const auto& [samples, noise_standard_deviation, initial_setpoint, setpoint_steps, steps, random_steps,
               step_interval, step_level] = options;
  return std::tie(samples, noise_standard_deviation, initial_setpoint, setpoint_steps, steps, random_steps,
                  step_interval, step_level);
}

}  // namespace

bool operator==(const SimulationOptions& a, const SimulationOptions& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
