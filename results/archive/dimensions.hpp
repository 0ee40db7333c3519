#pragma once

#include <string>
#include <vector>

#include "results/archive/hdf5_file.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Writes the dimensions `cv`, `mv` and `md`: the names of the variables, with their units and descriptions
/// in attributes.
void write_plant_dimensions(Hdf5Group& group, const PlantModel& plant);

/// Writes one dimension `name` with the names of variables.
void write_variable_dimension(Hdf5Group& group, const std::string& name, const std::string& long_name,
                              const std::vector<PlantModel::Variable>& variables);

/// Writes a dimension `name` of `count` consecutive whole numbers, starting at `first`, that count samples.
/// Along it, writes the variable `time_name` with the same points in the time unit of the plant.
void write_sample_dimension(Hdf5Group& group, const std::string& name, const std::string& long_name,
                            const std::string& time_name, const Study& study, int first, Eigen::Index count);

}  // namespace mpm
