#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "plants/linear/plant_model.hpp"
#include "results/records/record_columns.hpp"

namespace mpm {

/// What can be guessed about a study from a file of records.
struct DataSketch {
  std::string file;   ///< name of the file
  std::string table;  ///< [data] as text of a study file; a comment marks each guess
  double step = 0.0;  ///< median time between two rows, in the time unit of the plant; 0: no stamps
  std::map<std::string, double> noise;         ///< standard deviation of the noise of each CV with a column
  std::map<std::string, double> spread;        ///< standard deviation of each variable with a column
  std::map<std::string, std::string> rests;    ///< where each MV spends its time, in words
  std::map<std::string, std::size_t> periods;  ///< rows between two values of each CV and MD that is held
};

/// Examines a file of records for a plant. Finds the column of each variable (the one with its name, one with
/// the name in its heading, or the one with the nearest heading), the period, the operating point (means) and
/// the noise
///
///   sigma = 1.4826 median |y(k) - 2 y(k-1) + y(k-2)| / sqrt 6
///
/// which slow moves hardly change. For a plant without variables it lists the columns and describes their
/// values. Errors: those of stamped_rows().
DataSketch data_sketch(const PlantModel& plant, RecordColumns file);

}  // namespace mpm
