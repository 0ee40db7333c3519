#pragma once

#include <string>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "scenarios/study/study.hpp"

// Numbers that are allowed in a study but implausible: most of them are slips of a unit or of a sign.

namespace mpm {

/// Something that one should look at before a study is run.
struct StudyWarning {
  std::string key;     ///< of the study file: "controller.sample_time"
  std::string found;   ///< one clause with numbers and units
  std::string advice;  ///< one clause: what to do, or the consequence if it is intended
};

/// "KEY: FOUND; ADVICE"
std::string to_string(const StudyWarning& warning);

/// Returns warnings about what the study itself shows. T is the sum of the time constants of a channel from
/// an MV, theta its dead time, theta + 3 T its settling time (95 % of a step of a first-order channel).
///
/// - `plant.channel[].step`: a channel from step coefficients that the transfer function fits badly.
/// - `controller.sample_time`: above the smallest T, or above every dead time.
/// - `controller.prediction_horizon`: shorter than the longest settling time.
/// - `simulation.samples`: a record shorter than three settling times; fewer than 100 samples.
/// - `controller.cv.NAME.setpoint`, `simulation.step`: a setpoint outside of the hard limits of its CV.
/// - these two, `controller.cv.NAME.soft`, `simulation.limit_step`: a setpoint or range to which the MVs
///   within their hard limits cannot bring the CV, most often because of a wrong sign.
/// - `simulation.noise_standard_deviation`: 0; above 5 % of the soft range or of the largest setpoint step.
/// - `diagnosis.self_check`: a self-check by Ivar in a study without excitation.
/// - `experiments.healthy`: none, and no bad tunings, so that no false alarm can be counted.
std::vector<StudyWarning> study_warnings(const Study& study);

/// Returns warnings about what its basis case shows: a self-check that fails or passes at the edge of its
/// band, CVs whose variance is mostly noise, MVs that are often at a hard limit, worlds whose loop is not
/// stable without a fault.
std::vector<StudyWarning> basis_warnings(const Study& study, const BasisCase& basis);

}  // namespace mpm
