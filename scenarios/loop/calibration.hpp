#pragma once

#include <cstdint>

#include "scenarios/study/study.hpp"

// The loops on which the thresholds of the methods are calibrated.

namespace mpm {

/// The seed of the calibration loops: `calibration.seed` or, if the study names none, the seed of the study
/// with the bits of kCalibrationBits flipped, which always differs from it. The study must have a
/// calibration. Throws InputError if the named seed is that of the study (possible with `run --seed`).
std::uint64_t calibration_seed(const Study& study);

/// The letters "calibrat" as a number.
inline constexpr std::uint64_t kCalibrationBits = 0x63616C6962726174;

/// The study whose experiments are the calibration loops: `calibration.healthy` loops without a fault and
/// `calibration.ud` with a disturbance alone, drawn under calibration_seed(), in `calibration.worlds` worlds
/// of that seed where the study has worlds. Plant, controller, noise and excitation are those of the study.
/// If all of its experiments share their random steps, the calibration loops have the same steps: the answer
/// of a method for a healthy loop depends on how the loop is excited. The loops are assessed with the basis
/// case of `study` itself, from which the methods have learnt. The study must have a calibration. Throws
/// InputError as calibration_seed().
Study calibration_study(const Study& study);

}  // namespace mpm
