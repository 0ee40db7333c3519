#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/study_files/study_template.hpp"

namespace mpm {

/// What the user tells `init` about a plant, as it is typed: in options, or as answers.
struct SketchWords {
  std::string cvs, mvs, mds;  ///< names separated by commas, or how many
  std::string time_unit = "min";
  std::vector<std::string> units;                 ///< NAME=UNIT
  std::vector<std::string> channels;              ///< CV,INPUT=NUMERATOR/DENOMINATOR[@DEAD_TIME]
  std::string gains, time_constants, dead_times;  ///< "1 2; 3 4": one row per CV, one column per MV or MD
  std::optional<double> sample_time;
  std::vector<std::string> ranges, limits;  ///< NAME=LOW:HIGH
  std::vector<std::string> setpoints;       ///< NAME=SIZE
};

/// Reads these words into the sketch of a study of this name. Channels win over matrices. Errors: InputError,
/// which names the option.
StudySketch sketch_of(const SketchWords& words, const std::string& name);

}  // namespace mpm
