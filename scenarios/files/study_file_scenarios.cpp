#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "plants/non_finite.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

// Bounds on what a file can make the program do; far above any table of scenarios.
constexpr std::size_t kMaxScenarios = 1000;
constexpr std::size_t kMaxFaults = 200;  // of one sort in a scenario

bool has_any(const TomlTable& table, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(), [&table](const char* key) { return table.has(key); });
}

std::vector<TomlTable> read_faults(const TomlTable& scenario, const std::string& list) {
  if (!scenario.has(list)) {
    return {};
  }
  std::vector<TomlTable> tables = scenario.tables(list, study_file_keys("scenario[]." + list + "[]"));
  if (tables.size() > kMaxFaults) {
    scenario.refuse(list, fmt::format("a list of {}", tables.size()), fmt::format("at most {}", kMaxFaults));
  }
  return tables;
}

/// The changed parameters of a channel, in the order of MismatchParameter.
void read_changes(const TomlTable& table, const Mismatch& where, std::vector<Mismatch>& mismatches) {
  const std::array<std::tuple<const char*, MismatchParameter, NumberRule>, 3> changes{
      {{"gain_factor", MismatchParameter::gain, NumberRule::positive()},
       {"time_constant_factor", MismatchParameter::time_constant, NumberRule::positive()},
       {"dead_time_shift", MismatchParameter::dead_time, NumberRule::finite()}}};
  for (const auto& [key, parameter, rule] : changes) {
    if (table.has(key)) {
      mismatches.push_back(where);
      mismatches.back().parameter = parameter;
      mismatches.back().value = read_number(table, key, rule);
    }
  }
}

/// One entry of the list: a channel with some of its parameters changed, or another channel in its place.
std::vector<Mismatch> read_mismatch_of_channel(const TomlTable& table, const Study& study) {
  std::vector<std::string> inputs = variable_names(study.plant.mvs);
  const std::vector<std::string> mds = variable_names(study.plant.mds);
  inputs.insert(inputs.end(), mds.begin(), mds.end());
  const Mismatch where{
      .cv = static_cast<Eigen::Index>(read_one_of(table, "cv", variable_names(study.plant.cvs))),
      .input = static_cast<Eigen::Index>(read_one_of(table, "input", inputs)),
      .parameter = MismatchParameter::channel,
      .value = kNaN};
  const bool changes = has_any(table, {"gain_factor", "time_constant_factor", "dead_time_shift"});
  const bool channel = has_any(table, {"gain", "time_constant", "numerator", "denominator", "dead_time"});
  if (changes == channel) {
    table.refuse("", changes ? "changes of the channel beside another channel" : "no mismatch",
                 "either gain_factor, time_constant_factor and dead_time_shift, or a transfer function");
  }
  std::vector<Mismatch> mismatches;
  if (changes) {
    if (study.plant.G(where.cv, where.input).is_zero()) {
      table.refuse("input", "a channel that is zero in the model", "a transfer function in its place");
    }
    read_changes(table, where, mismatches);
  } else {
    mismatches.push_back(where);
    mismatches.back().channel = read_transfer_function(table);
  }
  return mismatches;
}

/// The channel of the plant must be one that a plant of the study may have.
void refuse_impossible_plant(const TomlTable& table, const Study& study,
                             const std::vector<Mismatch>& mismatches) {
  const TransferMatrix plant = table.located("", [&] { return with_mismatches(study.plant.G, mismatches); });
  const TransferFunction& channel = plant(mismatches.front().cv, mismatches.front().input);
  refuse_unstable(table, channel);
  if (!(channel.dead_time() / study.controller.sample_time <= kMaxDeadTimeSamples)) {
    table.refuse("", fmt::format("a dead time of {}", channel.dead_time()),
                 fmt::format("at most {} samples", kMaxDeadTimeSamples));
  }
}

std::vector<Mismatch> read_mismatches(const TomlTable& scenario, const Study& study) {
  if (study.nonlinear && scenario.has("mismatch")) {
    scenario.refuse("mismatch", "channels of a plant that is simulated as nonlinear", "parameter");
  }
  std::vector<Mismatch> mismatches;
  std::set<std::pair<Eigen::Index, Eigen::Index>> listed;
  for (const TomlTable& table : read_faults(scenario, "mismatch")) {
    std::vector<Mismatch> of_channel = read_mismatch_of_channel(table, study);
    refuse_impossible_plant(table, study, of_channel);
    if (!listed.emplace(of_channel.front().cv, of_channel.front().input).second) {
      table.refuse("", "a second mismatch of this channel", "every channel once");
    }
    std::move(of_channel.begin(), of_channel.end(), std::back_inserter(mismatches));
  }
  return mismatches;
}

StepSequence read_step_sequence(const TomlTable& table, int samples) {
  StepSequence sequence;
  for (const TomlTable& step : table.tables("steps", study_file_keys("scenario[].disturbance[].steps[]"))) {
    const auto low = sequence.steps.empty() ? 0 : sequence.steps.back().sample + 1;
    sequence.steps.push_back({.sample = static_cast<int>(read_whole(step, "sample", low, samples - 1)),
                              .level = read_number(step, "level", NumberRule::finite())});
  }
  return sequence;
}

DisturbanceSignal read_signal(const TomlTable& table, int samples) {
  std::vector<const char*> forms;
  for (const char* form : {"white", "sine", "ramp", "steps"}) {
    if (table.has(form)) {
      forms.push_back(form);
    }
  }
  if (forms.size() > 1) {
    table.refuse(forms[1], fmt::format("{} beside {}", forms[1], forms[0]), "one signal a disturbance");
  }
  if (table.has("hold") && !forms.empty() && !table.has("white")) {
    table.refuse("hold", fmt::format("hold beside {}", forms[0]), "hold of a white signal");
  }
  if (table.has("sine")) {
    const TomlTable sine = table.table("sine", study_file_keys("scenario[].disturbance[].sine"));
    return Sine{.amplitude = read_number(sine, "amplitude", NumberRule::finite()),
                .period = read_number(sine, "period", NumberRule::positive())};
  }
  if (table.has("ramp")) {
    const TomlTable ramp = table.table("ramp", study_file_keys("scenario[].disturbance[].ramp"));
    return Ramp{.slope = read_number(ramp, "slope", NumberRule::finite()),
                .start = read_number_or(ramp, "start", NumberRule::at_least(0), 0.0)};
  }
  if (table.has("steps")) {
    return read_step_sequence(table, samples);
  }
  return WhiteNoise{.factor = read_number_or(table, "white", NumberRule::positive(), 1.0),
                    .hold = static_cast<int>(read_whole_or(table, "hold", 1, samples, 1))};
}

/// G_d of a disturbance; a first-order one is kept by its two numbers, as that of a random disturbance.
void read_model(const TomlTable& table, double sample_time, Disturbance& disturbance) {
  const TransferFunction Gd = read_transfer_function(table);
  refuse_growing(table, Gd);
  if (!(Gd.dead_time() / sample_time <= kMaxDeadTimeSamples)) {
    table.refuse("dead_time", fmt::format("{}", Gd.dead_time()),
                 fmt::format("at most {} samples", kMaxDeadTimeSamples));
  }
  if (table.has("gain") && Gd.dead_time() == 0) {
    disturbance.model = DisturbanceModel::first_order;
    disturbance.gain = read_number(table, "gain", NumberRule::finite());
    disturbance.time_constant = read_number(table, "time_constant", NumberRule::positive());
  } else {
    disturbance.model = DisturbanceModel::transfer_function;
    disturbance.Gd = Gd;
  }
}

Disturbance read_one_disturbance(const TomlTable& table, const Study& study) {
  Disturbance disturbance{.cv = -1, .gain = kNaN, .time_constant = kNaN, .model = DisturbanceModel::direct};
  if (table.has("cv") && table.has("input")) {
    table.refuse("", "both cv and input", "exactly one of the two");
  }
  if (table.has("input")) {
    disturbance.inner_input = read_inner_input(table, study);
  } else {
    disturbance.cv = static_cast<Eigen::Index>(read_one_of(table, "cv", variable_names(study.plant.cvs)));
  }
  disturbance.signal = read_signal(table, study.simulation.samples);
  if (has_any(table, {"gain", "time_constant", "numerator", "denominator", "dead_time"})) {
    read_model(table, study.controller.sample_time, disturbance);
  } else if (!has_any(table, {"white", "sine", "ramp", "steps"})) {
    table.refuse("", "neither a signal nor a transfer function", "at least one of the two");
  }
  return disturbance;
}

std::vector<Disturbance> read_disturbances(const TomlTable& scenario, const Study& study) {
  std::vector<Disturbance> disturbances;
  for (const TomlTable& table : read_faults(scenario, "disturbance")) {
    disturbances.push_back(read_one_disturbance(table, study));
  }
  return disturbances;
}

/// A parameter and an inner input name no CV.
void refuse_unknown_truth(const TomlTable& table, const Scenario& scenario) {
  const bool inner =
      std::any_of(scenario.disturbances.begin(), scenario.disturbances.end(),
                  [](const Disturbance& disturbance) { return disturbance.inner_input.has_value(); });
  if (!scenario.parameters.empty() || inner) {
    table.refuse("affected", "nothing", "the CVs that the fault of the nonlinear plant affects");
  }
}

std::optional<std::vector<Eigen::Index>> read_affected(const TomlTable& table, const Scenario& scenario,
                                                       const Study& study) {
  const toml::node* node = table.find("affected");
  if (node == nullptr) {
    refuse_unknown_truth(table, scenario);
    return std::nullopt;
  }
  if (const toml::array* list = node->as_array(); list != nullptr && list->empty()) {
    table.record("affected", std::vector<std::string>{});
    return std::vector<Eigen::Index>{};
  }
  const std::vector<std::size_t> places = read_some_of(table, "affected", variable_names(study.plant.cvs));
  if (kind_of(scenario.mismatches, scenario.parameters, scenario.disturbances) == ExperimentKind::healthy) {
    table.refuse("affected", fmt::format("a list of {} in a scenario without fault", places.size()),
                 "an empty list");
  }
  return std::vector<Eigen::Index>(places.begin(), places.end());
}

}  // namespace

std::vector<Scenario> read_scenarios(const TomlTable& document, const Study& study) {
  if (!document.has("scenario")) {
    return {};
  }
  const std::vector<TomlTable> tables = document.tables("scenario", study_file_keys("scenario[]"));
  if (tables.size() > kMaxScenarios) {
    document.refuse("scenario", fmt::format("a list of {}", tables.size()),
                    fmt::format("at most {}", kMaxScenarios));
  }
  std::vector<Scenario> scenarios;
  std::set<std::string> names;
  for (const TomlTable& table : tables) {
    Scenario scenario;
    scenario.name = read_name(table, "name");
    scenario.description = read_text_or(table, "description", "");
    if (!names.insert(scenario.name).second) {
      table.refuse("name", fmt::format("'{}' for a second scenario", scenario.name), "every name once");
    }
    scenario.mismatches = read_mismatches(table, study);
    scenario.parameters = read_parameter_changes(table, study);
    scenario.disturbances = read_disturbances(table, study);
    scenario.affected_cvs = read_affected(table, scenario, study);
    scenarios.push_back(std::move(scenario));
  }
  return scenarios;
}

}  // namespace mpm
