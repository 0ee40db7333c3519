// The keys of a study whose plant is simulated by an FMU or by another program.

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "plants/outside/fmu_model.hpp"
#include "plants/outside/program_model.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostForeignVariables = 1000;  // limits the work that a file can cause

/// An entry of the lists `input`, `output` and `parameter`.
struct ForeignVariable {
  std::string name, variable;
  double value = 0.0;
  FmuSettings::Variable place = {};  ///< the variable of the FMU: `variable`, or `name` if that is empty
};
using ForeignVariables = std::vector<ForeignVariable>;

/// The values of [plant.fmu] and [plant.program].
struct ForeignPlant {
  std::string file;
  std::vector<std::string> command;
  double time_factor = FmuSettings().time_factor, step = FmuSettings().step;
  ForeignOptions options;
  ForeignVariables inputs, outputs, parameters;
};

/// A list of variables with distinct names.
OptionKey variables(const char* name, ForeignVariables& group,
                    std::function<OptionKeys(ForeignVariable&)> keys, const char* meaning) {
  return key::list<ForeignVariable>(
      name, kMostForeignVariables, std::move(keys),
      [&group](const TomlTable& table, ForeignVariable& entry) {
        for (const ForeignVariable& other : group)
          if (other.name == entry.name)
            table.refuse("name", fmt::format("'{}' a second time", entry.name), "every name once");
        const bool written = !entry.variable.empty() && table.has("variable");
        entry.place = {entry.variable.empty() ? entry.name : entry.variable,
                       table.where(written ? "variable" : "name")};
        group.push_back(entry);
      },
      meaning);
}

OptionKeys common_keys(ForeignPlant& plant) {
  return {
      key::number("settle", plant.options.settle, NumberRule::positive(),
                  "time for which inputs are held at the start; after it the plant is taken to be at rest")
          .required(),
      key::number("settle_tolerance", plant.options.settle_tolerance, NumberRule::positive(),
                  "largest change of an output over the last tenth of `settle`, relative to max(1, "
                  "abs(y)); a loop whose plant changes more is `failed`"),
      key::time_limit(
          plant.options.time_limit,
          "wall-clock seconds that one step or the start may take; a loop that needs more is `failed`")};
}

OptionKey name_key(ForeignVariable& entry, const char* meaning, const char* allowed) {
  return key::text("name", entry.name, meaning).required().allow(std::string(allowed) + "; no two alike");
}

OptionKey variable_key(ForeignVariable& entry, const char* allowed) {
  OptionKey made = key::text("variable", entry.variable, "name of its variable in the FMU")
                       .otherwise("`name`")
                       .allow(allowed);
  made.reader = [&entry](const TomlTable& table, const OptionKey& key) {
    entry.variable = read_text_or(table, key.name, entry.name);
  };
  return made;
}

OptionKey operating_key(ForeignVariable& entry) {
  return key::number("operating", entry.value, NumberRule::finite(), "its value at the operating point")
      .required();
}

OptionKeys input_keys(ForeignVariable& entry) {
  return {name_key(entry, "an MV or MD of the plant; another name is an inner input, where disturbances act",
                   "an MV, an MD, or a new name"),
          variable_key(entry, "a Real of causality input"), operating_key(entry)};
}

OptionKeys program_input_keys(ForeignVariable& entry) {
  return {name_key(entry, "an MV or MD of the plant; another name is an inner input, where disturbances act",
                   "an MV, an MD, or a new name"),
          operating_key(entry)};
}

OptionKeys output_keys(ForeignVariable& entry, const PlantModel& plant) {
  const auto read_name = [&](const TomlTable& table, const std::string& key) {
    const std::vector<std::string> names = variable_names(plant.cvs);
    entry.name = names[read_one_of(table, key, names)];
  };
  return {
      key::option("name", "text", "name of the CV").required().allow("a CV; no two alike").read(read_name),
      variable_key(entry, "a Real of causality output or local")};
}

OptionKeys parameter_keys(ForeignVariable& entry) {
  return {name_key(entry,
                   "its name in the FMU or in `reset`, and in `scenario[].parameter[]` and "
                   "`mismatch.plant_parameter[]`",
                   "for an FMU, a Real of causality parameter"),
          key::number("value", entry.value, NumberRule::finite(), "nominal value, which the study sets")
              .required()};
}

OptionKeys fmu_keys(ForeignPlant& plant, const PlantModel& model) {
  OptionKeys keys{
      key::text("file", plant.file,
                "path, relative to the folder of the study file; in a study that comes from an archive, "
                "relative to the current folder")
          .required()
          .allow("an FMU with a library for linux64"),
      key::number("time_factor", plant.time_factor, NumberRule::positive(),
                  "time units of the FMU (usually seconds) in one time unit of the study: 60 for `\"min\"`"),
      key::option("step", "number",
                  "longest communication step, in the time of the FMU. Each sample is divided into equal "
                  "steps, and inputs are held")
          .otherwise("a sample is one")
          .allow("> 0")
          .read([&plant](const TomlTable& table, const std::string& key) {
            plant.step = read_number(table, key, NumberRule::positive());
          })};
  for (OptionKey& key : common_keys(plant))
    keys.push_back(std::move(key));
  keys.push_back(variables("input", plant.inputs, input_keys, "inputs, 1000 at most")
                     .allow("one for each MV and MD; more are inner inputs")
                     .required());
  keys.push_back(variables(
                     "output", plant.outputs,
                     [&model](ForeignVariable& entry) { return output_keys(entry, model); },
                     "CVs whose variable has a name of its own in the FMU, 1000 at most")
                     .allow("CVs"));
  keys.push_back(variables("parameter", plant.parameters, parameter_keys,
                           "parameters that the study sets and that mismatches can change, 1000 at most"));
  return keys;
}

OptionKeys program_keys(ForeignPlant& plant, const PlantModel&) {
  OptionKeys keys{
      key::command("command", plant.command,
                   "the program, found in PATH, and its arguments; it runs in the current folder")};
  for (OptionKey& key : common_keys(plant))
    keys.push_back(std::move(key));
  keys.push_back(variables("input", plant.inputs, program_input_keys, "operating points, 1000 at most")
                     .allow("one for each MV and MD; more are inner inputs")
                     .required());
  keys.push_back(variables("parameter", plant.parameters, parameter_keys,
                           "parameters that mismatches can change, 1000 at most"));
  return keys;
}

const ForeignVariable* entry_of(const ForeignVariables& entries, const std::string& name) {
  for (const ForeignVariable& entry : entries)
    if (entry.name == name)
      return &entry;
  return nullptr;
}

/// Returns the inputs: MVs and MDs in the order of the plant, and then the inner inputs.
ForeignVariables ordered_inputs(const TomlTable& table, const ForeignVariables& entries,
                                const PlantModel& plant, NonlinearModel& model) {
  ForeignVariables inputs;
  const std::vector<std::string> of_plant = input_names(plant);
  for (const std::string& name : of_plant) {
    const ForeignVariable* const entry = entry_of(entries, name);
    if (entry == nullptr)
      table.refuse("input", fmt::format("no entry for '{}'", name), "one for each MV and MD of the plant");
    inputs.push_back(*entry);
  }
  for (const ForeignVariable& entry : entries)
    if (std::find(of_plant.begin(), of_plant.end(), entry.name) == of_plant.end()) {
      inputs.push_back(entry);
      model.inner_inputs.push_back(entry.name);
    }
  model.operating_input.resize(static_cast<Eigen::Index>(inputs.size()));
  for (std::size_t i = 0; i < inputs.size(); ++i)
    model.operating_input(static_cast<Eigen::Index>(i)) = inputs[i].value;
  return inputs;
}

/// Returns the path of a file that the study file names: relative to its folder or, if no such file exists,
/// to the current one.
fs::path file_beside(const fs::path& folder, const fs::path& file) {
  std::error_code no_status;
  const fs::path beside = folder / file;
  return fs::exists(beside, no_status) ? beside : file;
}

std::shared_ptr<const ForeignModel> fmu_of(const TomlTable& fmu, const ForeignPlant& said,
                                           const ForeignVariables& inputs, const PlantModel& plant,
                                           const fs::path& folder) {
  FmuSettings settings;
  settings.file = file_beside(folder, said.file);
  settings.place = fmu.where("file");
  settings.time_factor = said.time_factor;
  settings.step = said.step;
  for (const ForeignVariable& input : inputs)
    settings.inputs.push_back(input.place);
  for (const ForeignVariable& parameter : said.parameters)
    settings.parameters.push_back(parameter.place);
  for (const PlantModel::Variable& cv : plant.cvs) {
    const ForeignVariable* const entry = entry_of(said.outputs, cv.name);
    settings.outputs.push_back(entry == nullptr ? FmuSettings::Variable{cv.name, fmu.where("output")}
                                                : entry->place);
  }
  return fmu_model(std::move(settings), said.options);
}

std::shared_ptr<const ForeignModel> program_of(const ForeignPlant& said, const PlantModel& plant,
                                               const NonlinearModel& model) {
  ProgramSettings settings;
  settings.command = said.command;
  for (const ForeignVariable& parameter : said.parameters)
    settings.parameters.push_back(parameter.name);
  settings.mvs = static_cast<Eigen::Index>(plant.mvs.size());
  settings.mds = static_cast<Eigen::Index>(plant.mds.size());
  settings.inner = static_cast<Eigen::Index>(model.inner_inputs.size());
  settings.outputs = static_cast<Eigen::Index>(plant.cvs.size());
  return program_model(std::move(settings), said.options);
}

}  // namespace

OptionKeys foreign_keys() {
  const auto keys_of = [](OptionKeys (*keys)(ForeignPlant&, const PlantModel&)) {
    return [keys] {
      ForeignPlant plant;
      return keys(plant, PlantModel());
    };
  };
  return {key::option("fmu", "table",
                      "the plant is an FMU ([own_plant.md](own_plant.md)); the controller, T0 and y_sim keep "
                      "the linear model")
              .otherwise("none")
              .allow("not with `simulated`")
              .with("", keys_of(fmu_keys)),
          key::option("program", "table",
                      "the plant is a program that answers lines of JSON; the controller, T0 and y_sim keep "
                      "the linear model")
              .otherwise("none")
              .allow("not with `simulated` or `fmu`")
              .with("", keys_of(program_keys))};
}

NonlinearModel read_foreign_plant(const TomlTable& table, const PlantModel& plant, const fs::path& folder) {
  const std::string key = table.has("fmu") ? "fmu" : "program";
  for (const std::string& other : key_names(simulated_keys()))
    if (table.has(other))
      table.refuse(other, fmt::format("a key beside plant.{}", key),
                   fmt::format("plant.{} alone: it integrates itself", key));
  if (table.has("fmu") && table.has("program"))
    table.refuse("program", "a table beside plant.fmu", "one of the two");
  ForeignPlant said;
  const OptionKeys keys = key == "fmu" ? fmu_keys(said, plant) : program_keys(said, plant);
  const TomlTable foreign = table.table(key, key_names(keys));
  read_keys(foreign, keys);
  NonlinearModel model;
  const ForeignVariables inputs = ordered_inputs(foreign, said.inputs, plant, model);
  for (const ForeignVariable& parameter : said.parameters)
    model.parameters.push_back({parameter.name, parameter.value});
  model.foreign =
      key == "fmu" ? fmu_of(foreign, said, inputs, plant, folder) : program_of(said, plant, model);
  return model;
}

}  // namespace mpm
