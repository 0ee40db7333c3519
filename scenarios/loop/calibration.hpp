#pragma once

#include <cstdint>

#include "scenarios/study/study.hpp"

// The loops on which the thresholds of the methods are calibrated.

namespace mpm {

/// The seed of the calibration loops: `calibration.seed`, or, when the study names none, that of the study
/// with the bits of kCalibrationBits flipped, which is never the same. The study must have a calibration.
/// Throws InputError when the named seed is that of the study (by `run --seed`).
std::uint64_t calibration_seed(const Study& study);

/// The letters "calibrat" as a number.
inline constexpr std::uint64_t kCalibrationBits = 0x63616C6962726174;

/// The study whose experiments are the calibration loops: `calibration.healthy` loops without a fault and
/// `calibration.ud` with a disturbance alone, drawn under calibration_seed(), in `calibration.worlds` worlds
/// of that seed where the study has worlds. Plant, controller, noise and excitation are those of the study,
/// random steps included, which are the same in all of its experiments: the answer of a method for a healthy
/// loop depends on how the loop is moved. Its loops are assessed with the basis case of `study` itself, which
/// is what the methods have learnt. The study must have a calibration. Throws InputError as
/// calibration_seed().
Study calibration_study(const Study& study);

}  // namespace mpm
