#pragma once

#include <string>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "scenarios/study/study.hpp"

// What is allowed in a study and still implausible: most such numbers are slips of a unit or of a sign.

namespace mpm {

/// Something that one should look at before a study is run.
struct StudyWarning {
  std::string key;     ///< of the study file: "controller.sample_time"
  std::string found;   ///< one clause with numbers and units
  std::string advice;  ///< one clause: what to do, or the consequence if it is intended
};

/// "KEY: FOUND; ADVICE"
std::string to_string(const StudyWarning& warning);

/// What the study itself shows. T is the sum of the time constants of a channel from an MV, theta its dead
/// time, theta + 3 T its settling time (95 % of a step of a first-order channel).
///
/// - `controller.sample_time`: above the smallest T, or above every dead time.
/// - `controller.prediction_horizon`: shorter than the longest settling time.
/// - `simulation.samples`: a record shorter than three of them; fewer than 100 samples.
/// - `controller.cv.NAME.setpoint`, `simulation.step`: a setpoint outside of the hard limits of its CV.
/// - the same, `controller.cv.NAME.soft`, `simulation.limit_step`: a setpoint or range to which the MVs
///   within their hard limits cannot bring the CV, most often by a wrong sign.
/// - `simulation.noise_standard_deviation`: 0; above 5 % of the soft range or of the largest setpoint step.
/// - `diagnosis.self_check`: by Ivar in a study without excitation.
/// - `experiments.healthy`: none, so that no false alarm can be counted.
std::vector<StudyWarning> study_warnings(const Study& study);

/// What its basis case shows: a self-check that fails or passes at the edge of its band, CVs whose variance
/// is mostly noise, MVs that are at a hard limit, worlds whose loop is not stable without a fault.
std::vector<StudyWarning> basis_warnings(const Study& study, const BasisCase& basis);

}  // namespace mpm
