#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "plants/linear/plant_model.hpp"
#include "results/records/record_columns.hpp"

namespace mpm {

/// What can be guessed about a study from a file of records.
struct DataSketch {
  std::string file;   ///< its name
  std::string table;  ///< [data] as the text of a study file, each guess with a comment that calls it one
  double step = 0.0;  ///< median time between two rows, time unit of the plant; 0: the file has no stamps
  std::map<std::string, double> noise;         ///< of each CV that has a column: standard deviation
  std::map<std::string, double> spread;        ///< of each variable that has a column: standard deviation
  std::map<std::string, std::string> rests;    ///< where each MV spends its time, in words
  std::map<std::string, std::size_t> periods;  ///< of each CV and MD that is held in between: rows
};

/// Looks at a file for a plant: the column of each variable (its name, one that has it in its name, or the
/// nearest one), the period, the operating point (means) and the noise
///
///   sigma = 1.4826 median |y(k) - 2 y(k-1) + y(k-2)| / sqrt 6
///
/// which slow moves hardly change. A plant without variables gets a list of the columns and what they look
/// like. Errors: those of stamped_rows().
DataSketch data_sketch(const PlantModel& plant, RecordColumns file);

}  // namespace mpm
