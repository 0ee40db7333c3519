// The keys of a study whose plant somebody else simulates.

#include <filesystem>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plants/outside/fmu_model.hpp"
#include "plants/outside/program_model.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostForeignVariables = 1000;  // a bound on what a file can make the program do

using FmuVariables = std::vector<FmuSettings::Variable>;

/// The entries of a list, none of which has the name of another.
std::vector<TomlTable> read_entries(const TomlTable& table, const std::string& list,
                                    const std::string& keys) {
  if (!table.has(list))
    return {};
  std::vector<TomlTable> entries = table.tables(list, study_file_keys(keys));
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

/// The list `input`, each entry with its operating point: that of each MV and MD, in the order of the plant,
/// and then the inner inputs.
std::vector<TomlTable> read_inputs(const TomlTable& foreign, const std::string& keys, const PlantModel& plant,
                                   NonlinearModel& model) {
  const std::vector<TomlTable> entries = read_entries(foreign, "input", keys);
  std::vector<TomlTable> inputs;
  std::vector<double> operating;
  const auto take = [&](const TomlTable& entry) {
    inputs.push_back(entry);
    operating.push_back(read_number(entry, "operating", NumberRule::finite()));
  };
  std::set<std::string> of_plant;
  for (const auto* list : {&plant.mvs, &plant.mds})
    for (const PlantModel::Variable& variable : *list) {
      const TomlTable* const entry = entry_of(entries, variable.name);
      if (entry == nullptr)
        foreign.refuse("input", fmt::format("no entry for '{}'", variable.name),
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
  return inputs;
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

/// The list `parameter`, each entry with its nominal value.
std::vector<TomlTable> read_parameters(const TomlTable& foreign, const std::string& keys,
                                       NonlinearModel& model) {
  std::vector<TomlTable> entries = read_entries(foreign, "parameter", keys);
  for (const TomlTable& entry : entries)
    model.parameters.push_back({read_text(entry, "name"), read_number(entry, "value", NumberRule::finite())});
  return entries;
}

ForeignOptions read_options(const TomlTable& foreign) {
  const ForeignOptions standard;
  ForeignOptions options;
  options.settle = read_number(foreign, "settle", NumberRule::positive());
  options.settle_tolerance =
      read_number_or(foreign, "settle_tolerance", NumberRule::positive(), standard.settle_tolerance);
  options.time_limit = read_time_limit_or(foreign, "time_limit", standard.time_limit);
  return options;
}

/// A path of the study file: from its folder or, when nothing is there, from the current one.
fs::path file_beside(const fs::path& folder, const fs::path& file) {
  std::error_code no_status;
  const fs::path beside = folder / file;
  return fs::exists(beside, no_status) ? beside : file;
}

FmuVariables variables_of(const std::vector<TomlTable>& entries) {
  FmuVariables variables;
  for (const TomlTable& entry : entries)
    variables.push_back(read_variable(entry));
  return variables;
}

/// [plant.fmu]
NonlinearModel read_fmu(const TomlTable& fmu, const PlantModel& plant, const fs::path& folder) {
  NonlinearModel model;
  FmuSettings settings;
  settings.file = file_beside(folder, read_text(fmu, "file"));
  settings.place = fmu.where("file");
  settings.time_factor = read_number_or(fmu, "time_factor", NumberRule::positive(), settings.time_factor);
  const ForeignOptions options = read_options(fmu);
  settings.inputs = variables_of(read_inputs(fmu, "plant.fmu.input[]", plant, model));
  settings.outputs = read_outputs(fmu, plant);
  for (const TomlTable& entry : read_parameters(fmu, "plant.fmu.parameter[]", model))
    settings.parameters.push_back({read_text(entry, "name"), entry.where("name")});
  model.foreign = fmu_model(std::move(settings), options);
  return model;
}

/// [plant.program]
NonlinearModel read_program(const TomlTable& program, const PlantModel& plant) {
  NonlinearModel model;
  ProgramSettings settings;
  settings.command = read_command(program, "command");
  const ForeignOptions options = read_options(program);
  read_inputs(program, "plant.program.input[]", plant, model);
  read_parameters(program, "plant.program.parameter[]", model);
  for (const NonlinearModel::Parameter& parameter : model.parameters)
    settings.parameters.push_back(parameter.name);
  settings.mvs = static_cast<Eigen::Index>(plant.mvs.size());
  settings.mds = static_cast<Eigen::Index>(plant.mds.size());
  settings.inner = static_cast<Eigen::Index>(model.inner_inputs.size());
  settings.outputs = static_cast<Eigen::Index>(plant.cvs.size());
  model.foreign = program_model(std::move(settings), options);
  return model;
}

}  // namespace

NonlinearModel read_foreign_plant(const TomlTable& table, const PlantModel& plant, const fs::path& folder) {
  const std::string key = table.has("fmu") ? "fmu" : "program";
  const auto refuse_beside = [&](const char* other) {
    if (table.has(other))
      table.refuse(other, fmt::format("a key beside plant.{}", key),
                   fmt::format("plant.{} alone: it integrates itself", key));
  };
  refuse_beside("simulated");
  for (const char* other : kIntegrationKeys)
    refuse_beside(other);
  if (table.has("fmu") && table.has("program"))
    table.refuse("program", "a table beside plant.fmu", "one of the two");
  const TomlTable foreign = table.table(key, study_file_keys("plant." + key));
  return key == "fmu" ? read_fmu(foreign, plant, folder) : read_program(foreign, plant);
}

}  // namespace mpm
