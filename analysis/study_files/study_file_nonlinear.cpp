// The keys of a study whose plant is nonlinear.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "plants/models/catalogue.hpp"
#include "plants/nonlinear/ode_integrator.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMaxParameters = 200;  // limits the work that a file can cause
constexpr const char* kNonlinear = "plant.simulated = \"nonlinear\", plant.fmu or plant.program";

OptionKeys integration_keys(OdeOptions& options) {
  OptionKeys keys{key::choice("integrator", options.method, {"runge-kutta", "bdf"},
                              "method that integrates the equations of the plant ([plants.md](plants.md)); "
                              "`\"bdf\"` for stiff ones"),
                  key::number("relative_tolerance", options.relative_tolerance, NumberRule::positive(),
                              "tolerance of the integration: local error of a step, relative to the state")
                      .allow("1e-13 to below 1"),
                  key::number("absolute_tolerance", options.absolute_tolerance, NumberRule::positive(),
                              "tolerance of the integration, in the unit of the state"),
                  key::whole("step_limit", options.step_limit, 1, std::numeric_limits<int>::max(),
                             "integration steps allowed per sample; a loop that needs more is `failed`")
                      .allow(">= 1")};
  for (OptionKey& key : keys)
    key.allowed += "; with `\"nonlinear\"`";
  return keys;
}

OptionKey simulated_key(bool& nonlinear) {
  return key::choice("simulated", nonlinear, {"linear", "nonlinear"},
                     "form of the plant in the loops. The controller, T0 and y_sim keep the linear model")
      .allow("`\"linear\"`, or `\"nonlinear\"` for a catalogue plant that has [a nonlinear form](plants.md)");
}

/// Returns the names of the catalogue plants that have a nonlinear form.
std::string nonlinear_names() {
  std::string names;
  for (const std::string& name : benchmark_plant_names())
    if (nonlinear_benchmark_plant(name))
      names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// Returns the parameter that the key `name` names.
const NonlinearModel::Parameter& read_parameter(const TomlTable& table, const NonlinearModel& model) {
  std::vector<std::string> names;
  for (const NonlinearModel::Parameter& parameter : model.parameters)
    names.push_back(parameter.name);
  return model.parameters[read_one_of(table, "name", names)];
}

ParameterChange read_change(const TomlTable& table, const NonlinearModel& model) {
  const NonlinearModel::Parameter& parameter = read_parameter(table, model);
  if (table.has("value") == table.has("factor"))
    table.refuse("", table.has("value") ? "both value and factor" : "neither value nor factor",
                 "exactly one of the two");
  const double value = table.has("value")
                           ? read_number(table, "value", NumberRule::finite())
                           : parameter.nominal * read_number(table, "factor", NumberRule::finite());
  return {parameter.name, value};
}

OptionKeys change_keys(ParameterChange&) {
  return {key::option("name", "text", "name of the parameter")
              .otherwise("required")
              .allow("a parameter of the plant ([plants.md](plants.md)), each once in a scenario"),
          key::option("value", "number", "value in the plant", "of the parameter")
              .otherwise("this or `factor`")
              .allow("what the plant can have"),
          key::option("factor", "number", "value in the plant, as a multiple of the value in the model", "1")
              .otherwise("this or `value`")
              .allow("as there")};
}

/// An entry of the list `plant_parameter`.
struct ListedRange {
  PlantParameterRange range{"", Distribution::constant(1), {}};
};

OptionKeys range_keys(PlantParameterRange& range, const Study& study) {
  const auto read_name = [&](const TomlTable& table, const std::string&) {
    range.name = read_parameter(table, study.nonlinear->model).name;
  };
  const auto check_ends = [&](const TomlTable& table) {
    const NonlinearModel::Parameter& parameter = read_parameter(table, study.nonlinear->model);
    for (const double end : {range.factor.minimum(), range.factor.maximum()})
      table.located("factor", [&] {
        study.nonlinear->model.check({{parameter.name, end * parameter.nominal}});
      });
  };
  return {
      key::option("name", "text", "name of the parameter")
          .required()
          .allow("a parameter of the nonlinear plant")
          .read(read_name),
      key::distribution("factor", range.factor, NumberRule::positive(), "factor of its nominal value", "1")
          .required()
          .also("both ends must be possible"),
      key::check(check_ends),
      key::some_of(
          "affected", range.affected_cvs, [&] { return variable_names(study.plant.cvs); },
          "CVs that a diagnosis should find")
          .required()
          .allow("names of CVs")};
}

}  // namespace

OptionKeys simulated_keys() {
  bool nonlinear = false;
  OdeOptions options;
  OptionKeys keys{simulated_key(nonlinear)};
  for (OptionKey& key : integration_keys(options))
    keys.push_back(std::move(key));
  return described(std::move(keys));
}

std::optional<NonlinearSimulation> read_nonlinear_simulation(const TomlTable& plant, const PlantModel& linear,
                                                             const std::filesystem::path& folder) {
  if (plant.has("fmu") || plant.has("program"))
    return NonlinearSimulation{read_foreign_plant(plant, linear, folder), OdeOptions{}};
  bool nonlinear = false;
  read_keys(plant, {simulated_key(nonlinear)});
  OdeOptions options;
  const OptionKeys integration = integration_keys(options);
  if (!nonlinear) {
    for (const std::string& key : key_names(integration))
      if (plant.has(key))
        plant.refuse(key, "a key of the integration of a nonlinear plant", "plant.simulated = \"nonlinear\"");
    return std::nullopt;
  }
  if (!plant.has("catalogue"))
    plant.refuse("simulated", "'nonlinear' for a plant of the file", "a plant of the catalogue");
  const std::string name = read_text(plant, "catalogue");
  std::optional<NonlinearModel> model = nonlinear_benchmark_plant(name);
  if (!model)
    plant.refuse("simulated", fmt::format("'nonlinear' for {}, which is linear", in_quotes(name)),
                 nonlinear_names());
  read_keys(plant, integration);
  plant.located("", [&] { return options.validate(); });
  return NonlinearSimulation{std::move(*model), options};
}

OptionKey parameter_changes_key(std::vector<ParameterChange>& changes, const Study& study) {
  const auto refuse_linear = [&study](const TomlTable& scenario) {
    if (scenario.has("parameter") && !study.nonlinear)
      scenario.refuse("parameter", "parameters of a plant that is simulated with its linear model",
                      kNonlinear);
  };
  const auto take = [&](const TomlTable& table, ParameterChange&) {
    const ParameterChange change = read_change(table, study.nonlinear->model);
    for (const ParameterChange& other : changes)
      if (other.name == change.name)
        table.refuse("name", fmt::format("'{}' a second time", change.name), "every parameter once");
    changes.push_back(change);
    table.located("", [&] { study.nonlinear->model.check(changes); });
  };
  return key::list<ParameterChange>("parameter", kMaxParameters, change_keys, take,
                                    "parameters of the plant that differ from those of the model")
      .allow("1 to 200; for a nonlinear plant")
      .after(refuse_linear);
}

OptionKey plant_parameters_key(std::vector<PlantParameterRange>& ranges, const Study& study) {
  const auto check_plant = [&study](const TomlTable& mismatch) {
    const bool drawn = study.experiments.mpm + study.experiments.mpm_ud > 0;
    if (!mismatch.has("plant_parameter") && study.nonlinear && drawn)
      mismatch.refuse("plant_parameter", "nothing",
                      "the parameters that random mismatches of the nonlinear plant change");
    if (mismatch.has("plant_parameter") && !study.nonlinear)
      mismatch.refuse("plant_parameter", "parameters of a plant that is simulated with its linear model",
                      kNonlinear);
  };
  return key::list<ListedRange>(
             "plant_parameter", kMaxParameters,
             [&study](ListedRange& listed) { return range_keys(listed.range, study); },
             [&ranges](const TomlTable&, ListedRange& listed) { ranges.push_back(listed.range); },
             "parameters of a nonlinear plant. A mismatch changes one of them, each equally often, and no "
             "channel")
      .allow("of a nonlinear plant")
      .after(check_plant);
}

Eigen::Index read_inner_input(const TomlTable& disturbance, const Study& study) {
  if (!study.nonlinear)
    disturbance.refuse("input", "an inner input of a plant that is simulated with its linear model",
                       kNonlinear);
  return static_cast<Eigen::Index>(read_one_of(disturbance, "input", study.nonlinear->model.inner_inputs));
}

}  // namespace mpm
