#include "results/archive/dimensions.hpp"

#include <cstdint>
#include <numeric>

#include "results/archive/variable_text.hpp"

namespace mpm {

void write_plant_dimensions(Hdf5Group& group, const PlantModel& plant) {
  write_variable_dimension(group, "cv", "controlled variable", plant.cvs);
  write_variable_dimension(group, "mv", "manipulated variable", plant.mvs);
  write_variable_dimension(group, "md", "measured disturbance", plant.mds);
}

void write_variable_dimension(Hdf5Group& group, const std::string& name, const std::string& long_name,
                              const std::vector<PlantModel::Variable>& variables) {
  std::vector<std::string> names, units, descriptions;
  for (const PlantModel::Variable& variable : variables) {
    names.push_back(variable.name);
    units.push_back(unit_text(variable.unit));
    descriptions.push_back(variable.description);
  }
  Attributes list = attributes<std::string>({name, long_name});
  if (!variables.empty()) {
    list.emplace_back("variable_units", units);
    list.emplace_back("variable_descriptions", descriptions);
  }
  group.write_dimension(name, names, list);
}

void write_sample_dimension(Hdf5Group& group, const std::string& name, const std::string& long_name,
                            const std::string& time_name, const Study& study, int first, Eigen::Index count) {
  std::vector<std::int32_t> samples(static_cast<std::size_t>(count));
  std::iota(samples.begin(), samples.end(), first);
  group.write_dimension(name, samples, attributes<std::int32_t>({name, long_name}));
  std::vector<double> time;
  time.reserve(samples.size());
  for (const std::int32_t sample : samples)
    time.push_back(sample * study.controller.sample_time);
  group.write(time_name, {name}, time,
              attributes<double>({time_name, "time of the " + name, unit_text(study.plant.time_unit)}));
}

}  // namespace mpm
