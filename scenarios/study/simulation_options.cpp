#include "scenarios/study/simulation_options.hpp"

#include <tuple>

#include "base/same_members.hpp"

namespace mpm {
namespace {

auto members(const SimulationOptions& options) {
  const auto& [samples, noise_standard_deviation, noise, initial_setpoint, setpoint_steps, limit_steps, steps,
               random_steps, step_interval, step_level, md_noise_standard_deviation, md_noise_time_constant,
               dither, off, excitation] = options;
  return std::tie(samples, noise_standard_deviation, noise, initial_setpoint, setpoint_steps, limit_steps,
                  steps, random_steps, step_interval, step_level, md_noise_standard_deviation,
                  md_noise_time_constant, dither, off, excitation);
}

}  // namespace

bool operator==(const SimulationOptions& a, const SimulationOptions& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
