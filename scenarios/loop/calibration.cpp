#include "scenarios/loop/calibration.hpp"

#include <cassert>

#include <fmt/format.h>

#include "base/error.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
std::uint64_t calibration_seed(const Study& study) {
  assert(study.calibration);
  if (!study.calibration->seed)
    return study.seed ^ kCalibrationBits;
  if (*study.calibration->seed == study.seed)
    throw InputError("calibration.seed", fmt::format("{}, the seed of the study", study.seed), "another one");
  return *study.calibration->seed;
}

Study calibration_study(const Study& study) {
  Study loops = study;
  loops.seed = calibration_seed(study);
  loops.experiments = {};
  loops.monitoring.reset();
  loops.experiments.healthy = study.calibration->healthy;
  loops.experiments.ud = study.calibration->ud;
  if (loops.world)
    loops.world->count = study.calibration->worlds.value_or(loops.world->count);
  if (study.simulation.excitation == SignalSequence::shared &&
      (study.simulation.random_steps || study.simulation.md_noise_standard_deviation.size() > 0)) {
    loops.simulation.steps = as_steps(measured_disturbances(study));
    loops.simulation.random_steps = false;
    loops.simulation.md_noise_standard_deviation = {};
  }
  return loops;
}

}  // namespace mpm
