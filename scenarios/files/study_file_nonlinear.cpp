// The keys of a study whose plant is nonlinear.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "plants/models/catalogue.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMaxParameters = 200;  // a bound on what a file can make the program do
constexpr const char* kIntegrated = "plant.simulated = \"nonlinear\"";
constexpr const char* kNonlinear = "plant.simulated = \"nonlinear\", plant.fmu or plant.program";

OdeOptions read_integration(const TomlTable& plant) {
  const OdeOptions standard;
  OdeOptions options{.method = read_choice_or<OdeMethod>(
                         plant, "integrator",
                         {{"runge-kutta", OdeMethod::runge_kutta}, {"bdf", OdeMethod::bdf}}, standard.method),
                     .relative_tolerance = read_number_or(plant, "relative_tolerance", NumberRule::positive(),
                                                          standard.relative_tolerance),
                     .absolute_tolerance = read_number_or(plant, "absolute_tolerance", NumberRule::positive(),
                                                          standard.absolute_tolerance),
                     .step_limit = static_cast<int>(read_whole_or(
                         plant, "step_limit", 1, std::numeric_limits<int>::max(), standard.step_limit))};
  plant.located("", [&] { return options.validate(); });
  return options;
}

/// The catalogue plants that have a nonlinear form.
std::string nonlinear_names() {
  std::string names;
  for (const std::string& name : benchmark_plant_names())
    if (nonlinear_benchmark_plant(name))
      names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// The parameter that the key `name` names.
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

}  // namespace

std::optional<NonlinearSimulation> read_nonlinear_simulation(const TomlTable& document,
                                                             const PlantModel& linear,
                                                             const std::filesystem::path& folder) {
  const TomlTable plant = document.table("plant", study_file_keys("plant"));
  if (plant.has("fmu") || plant.has("program"))
    return NonlinearSimulation{read_foreign_plant(plant, linear, folder), OdeOptions{}};
  const bool nonlinear =
      read_choice_or<bool>(plant, "simulated", {{"linear", false}, {"nonlinear", true}}, false);
  if (!nonlinear) {
    for (const char* key : kIntegrationKeys)
      if (plant.has(key))
        plant.refuse(key, "a key of the integration of a nonlinear plant", kIntegrated);
    return std::nullopt;
  }
  if (!plant.has("catalogue"))
    plant.refuse("simulated", "'nonlinear' for a plant of the file", "a plant of the catalogue");
  const std::string name = read_text(plant, "catalogue");
  std::optional<NonlinearModel> model = nonlinear_benchmark_plant(name);
  if (!model)
    plant.refuse("simulated", fmt::format("'nonlinear' for {}, which is linear", in_quotes(name)),
                 nonlinear_names());
  return NonlinearSimulation{std::move(*model), read_integration(plant)};
}

std::vector<ParameterChange> read_parameter_changes(const TomlTable& scenario, const Study& study) {
  if (!scenario.has("parameter"))
    return {};
  if (!study.nonlinear)
    scenario.refuse("parameter", "parameters of a plant that is simulated by its linear model", kNonlinear);
  const std::vector<TomlTable> tables =
      scenario.tables("parameter", study_file_keys("scenario[].parameter[]"));
  if (tables.size() > kMaxParameters)
    scenario.refuse("parameter", fmt::format("a list of {}", tables.size()),
                    fmt::format("at most {}", kMaxParameters));
  std::vector<ParameterChange> changes;
  std::set<std::string> listed;
  for (const TomlTable& table : tables) {
    changes.push_back(read_change(table, study.nonlinear->model));
    if (!listed.insert(changes.back().name).second)
      table.refuse("name", fmt::format("'{}' a second time", changes.back().name), "every parameter once");
    table.located("", [&] { study.nonlinear->model.check(changes); });
  }
  return changes;
}

std::vector<PlantParameterRange> read_plant_parameters(const TomlTable& mismatch, const Study& study) {
  const bool drawn = study.experiments.mpm + study.experiments.mpm_ud > 0;
  if (!mismatch.has("plant_parameter")) {
    if (study.nonlinear && drawn)
      mismatch.refuse("plant_parameter", "nothing",
                      "the parameters that random mismatches of the nonlinear "
                      "plant change");
    return {};
  }
  if (!study.nonlinear)
    mismatch.refuse("plant_parameter", "parameters of a plant that is simulated by its linear model",
                    kNonlinear);
  std::vector<PlantParameterRange> ranges;
  for (const TomlTable& table :
       mismatch.tables("plant_parameter", study_file_keys("mismatch.plant_parameter[]"))) {
    const NonlinearModel::Parameter& parameter = read_parameter(table, study.nonlinear->model);
    const Distribution factor = read_distribution(table, "factor", NumberRule::positive());
    for (const double end : {factor.minimum(), factor.maximum()})
      table.located("factor", [&] {
        study.nonlinear->model.check({{parameter.name, end * parameter.nominal}});
      });
    PlantParameterRange range{parameter.name, factor, {}};
    for (const std::size_t cv : read_some_of(table, "affected", variable_names(study.plant.cvs)))
      range.affected_cvs.push_back(static_cast<Eigen::Index>(cv));
    ranges.push_back(std::move(range));
  }
  return ranges;
}

Eigen::Index read_inner_input(const TomlTable& disturbance, const Study& study) {
  if (!study.nonlinear)
    disturbance.refuse("input", "an inner input of a plant that is simulated by its linear model",
                       kNonlinear);
  return static_cast<Eigen::Index>(read_one_of(disturbance, "input", study.nonlinear->model.inner_inputs));
}

}  // namespace mpm
