// The keys of a study whose plant somebody else simulates.

#include <filesystem>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plants/fmu_model.hpp"
#include "scenarios/study_file_keys.hpp"
#include "scenarios/study_file_parts.hpp"
#include "scenarios/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostForeignVariables = 1000;  // a bound on what a file can make the program do
constexpr double kLongestTimeLimit = 86400.0;        // s

using FmuVariables = std::vector<FmuSettings::Variable>;

/// The entries of a list, none of which has the name of another.
std::vector<TomlTable> read_entries(const TomlTable& table, const std::string& list,
                                    const std::string& keys) {
  if (!table.has(list))
    return {};
  const std::vector<TomlTable> entries = table.tables(list, study_file_keys(keys));
  if (entries.size() > kMostForeignVariables)
    table.refuse(list, fmt::format("a list of {}", entries.size()),
                 fmt::format("at most {}", kMostForeignVariables));
  std::set<std::string> names;
  for (const TomlTable& entry : entries)
    if (const std::string name = read_text(entry, "name"); !names.insert(name).second)
      entry.refuse("name", fmt::format("'{}' a second time", name), "every name once");
  return entries;
}

/// The entry of this name; null without one.
const TomlTable* entry_of(const std::vector<TomlTable>& entries, const std::string& name) {
  for (const TomlTable& entry : entries)
    if (read_text(entry, "name") == name)
      return &entry;
  return nullptr;
}

/// The variable of an entry: that which it names, or that of its own name.
FmuSettings::Variable read_variable(const TomlTable& entry) {
  const std::string name = read_text_or(entry, "variable", read_text(entry, "name"));
  return {name, entry.where(entry.has("variable") ? "variable" : "name")};
}

/// The list `input`: that of each MV and MD, in the order of the plant, and then the inner inputs.
FmuVariables read_inputs(const TomlTable& fmu, const PlantModel& plant, NonlinearModel& model) {
  const std::vector<TomlTable> entries = read_entries(fmu, "input", "plant.fmu.input[]");
  FmuVariables variables;
  std::vector<double> operating;
  const auto take = [&](const TomlTable& entry) {
    variables.push_back(read_variable(entry));
    operating.push_back(read_number(entry, "operating", NumberRule::finite()));
  };
  std::set<std::string> of_plant;
  for (const auto* list : {&plant.mvs, &plant.mds})
    for (const PlantModel::Variable& variable : *list) {
      const TomlTable* const entry = entry_of(entries, variable.name);
      if (entry == nullptr)
        fmu.refuse("input", fmt::format("no entry for '{}'", variable.name),
                   "one for each MV and MD of the plant");
      take(*entry);
      of_plant.insert(variable.name);
    }
  for (const TomlTable& entry : entries)
    if (const std::string name = read_text(entry, "name"); of_plant.count(name) == 0) {
      take(entry);
      model.inner_inputs.push_back(name);
    }
  model.operating_input =
      Eigen::Map<const Eigen::VectorXd>(operating.data(), static_cast<Eigen::Index>(operating.size()));
  return variables;
}

/// The list `output`: of each CV the variable of its entry, or that of its own name.
FmuVariables read_outputs(const TomlTable& fmu, const PlantModel& plant) {
  const std::vector<TomlTable> entries = read_entries(fmu, "output", "plant.fmu.output[]");
  for (const TomlTable& entry : entries)
    read_one_of(entry, "name", variable_names(plant.cvs));
  FmuVariables variables;
  for (const PlantModel::Variable& cv : plant.cvs) {
    const TomlTable* const entry = entry_of(entries, cv.name);
    variables.push_back(entry == nullptr ? FmuSettings::Variable{cv.name, fmu.where("output")}
                                         : read_variable(*entry));
  }
  return variables;
}

FmuVariables read_parameters(const TomlTable& fmu, NonlinearModel& model) {
  FmuVariables variables;
  for (const TomlTable& entry : read_entries(fmu, "parameter", "plant.fmu.parameter[]")) {
    const std::string name = read_text(entry, "name");
    model.parameters.push_back({name, read_number(entry, "value", NumberRule::finite())});
    variables.push_back({name, entry.where("name")});
  }
  return variables;
}

ForeignOptions read_options(const TomlTable& fmu) {
  const ForeignOptions standard;
  ForeignOptions options;
  options.settle = read_number(fmu, "settle", NumberRule::positive());
  options.settle_tolerance =
      read_number_or(fmu, "settle_tolerance", NumberRule::positive(), standard.settle_tolerance);
  options.time_limit = read_number_or(fmu, "time_limit", NumberRule::positive(), standard.time_limit);
  if (options.time_limit > kLongestTimeLimit)
    fmu.refuse("time_limit", fmt::to_string(options.time_limit),
               fmt::format("at most {} s", kLongestTimeLimit));
  return options;
}

/// A path of the study file: from its folder or, when nothing is there, from the current one.
fs::path file_beside(const fs::path& folder, const fs::path& file) {
  std::error_code no_status;
  const fs::path beside = folder / file;
  return fs::exists(beside, no_status) ? beside : file;
}

}  // namespace

NonlinearModel read_foreign_plant(const TomlTable& table, const PlantModel& plant, const fs::path& folder) {
  for (const char* key : {"simulated", "relative_tolerance", "absolute_tolerance", "step_limit"})
    if (table.has(key))
      table.refuse(key, "a key beside plant.fmu", "plant.fmu alone: an FMU integrates itself");
  const TomlTable fmu = table.table("fmu", study_file_keys("plant.fmu"));
  NonlinearModel model;
  FmuSettings settings;
  settings.file = file_beside(folder, read_text(fmu, "file"));
  settings.place = fmu.where("file");
  settings.time_factor = read_number_or(fmu, "time_factor", NumberRule::positive(), settings.time_factor);
  const ForeignOptions options = read_options(fmu);
  settings.inputs = read_inputs(fmu, plant, model);
  settings.outputs = read_outputs(fmu, plant);
  settings.parameters = read_parameters(fmu, model);
  model.foreign = fmu_model(std::move(settings), options);
  return model;
}

}  // namespace mpm
