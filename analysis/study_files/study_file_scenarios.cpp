// [[scenario]]

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/transfer_function_keys.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

// Limits on the work that a file can cause; far above any table of scenarios.
constexpr std::size_t kMaxScenarios = 1000;
constexpr std::size_t kMaxFaults = 200;  // of one sort in a scenario

bool has_any(const TomlTable& table, const OptionKeys& keys) {
  return std::any_of(keys.begin(), keys.end(),
                     [&table](const OptionKey& key) { return table.has(key.name); });
}

OptionKeys joined(OptionKeys keys, const OptionKeys& others) {
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

/// The keys of a transfer function that replaces a channel.
OptionKeys other_channel_keys() {
  return transfer_function_keys(
      "input", "poles with negative real parts; one pole may be 0 if the model of the CV has one");
}

/// The key of a changed parameter of a channel.
OptionKey change_key(const char* name, MismatchParameter parameter, const NumberRule& rule, Mismatch& at,
                     std::vector<Mismatch>& mismatches, const char* meaning, const char* unit) {
  return key::option(name, "number", meaning, unit)
      .otherwise("none")
      .read([&at, &mismatches, parameter, rule](const TomlTable& table, const std::string& key) {
        mismatches.push_back(at);
        mismatches.back().parameter = parameter;
        mismatches.back().value = read_number(table, key, rule);
      });
}

/// In the order of MismatchParameter.
OptionKeys change_keys(Mismatch& at, std::vector<Mismatch>& mismatches) {
  return {change_key("gain_factor", MismatchParameter::gain, NumberRule::positive(), at, mismatches,
                     "factor of the gain", "1")
              .allow("> 0"),
          change_key("time_constant_factor", MismatchParameter::time_constant, NumberRule::positive(), at,
                     mismatches, "factor of the time constants", "1")
              .allow("> 0"),
          change_key("dead_time_shift", MismatchParameter::dead_time, NumberRule::finite(), at, mismatches,
                     "added to the dead time", "time")
              .allow("at least minus the dead time")};
}

/// An entry of the list: a channel with some of its parameters changed, or a transfer function in its place.
struct ListedMismatch {
  Mismatch at{.cv = 0, .input = 0, .parameter = MismatchParameter::channel, .value = kNaN};
  std::vector<Mismatch> mismatches;
};

OptionKeys mismatch_keys(ListedMismatch& listed, const Study& study) {
  const auto check_form = [&](const TomlTable& table) {
    const bool changes = has_any(table, change_keys(listed.at, listed.mismatches));
    if (changes == has_any(table, other_channel_keys()))
      table.refuse("", changes ? "changes of the channel beside another channel" : "no mismatch",
                   "either gain_factor, time_constant_factor and dead_time_shift, or a transfer function");
    if (changes && study.plant.G(listed.at.cv, listed.at.input).is_zero())
      table.refuse("input", "a channel that is zero in the model", "a transfer function in its place");
  };
  const auto read_channel = [&listed](const TomlTable& table) {
    if (has_any(table, other_channel_keys())) {
      listed.mismatches.push_back(listed.at);
      listed.mismatches.back().channel = read_transfer_function(table).function;
    }
  };
  const OptionKeys where{
      key::one_of(
          "cv", listed.at.cv, [&study] { return variable_names(study.plant.cvs); }, "output of the channel")
          .allow("name of a CV"),
      key::one_of(
          "input", listed.at.input, [&study] { return input_names(study.plant); },
          "input of the channel; a scenario lists a channel at most once. With an MD it is a mismatch of the "
          "feed-forward")
          .allow("name of an MV or MD"),
      key::check(check_form)};
  return joined(joined(joined(where, change_keys(listed.at, listed.mismatches)), other_channel_keys()),
                {key::check(read_channel)});
}

/// Takes the mismatches of one channel. The changed channel must be one that a plant of the study may have,
/// and the list must name it only once.
void take_mismatches(const TomlTable& table, const std::vector<Mismatch>& of_channel, const Study& study,
                     std::vector<Mismatch>& mismatches) {
  const Mismatch& first = of_channel.front();
  const TransferMatrix plant = table.located("", [&] { return with_mismatches(study.plant.G, of_channel); });
  const TransferFunction& channel = plant(first.cv, first.input);
  refuse_unstable(table, channel,
                  study.plant.G.is_integrating(first.cv) ? PolesAtOrigin::one : PolesAtOrigin::none);
  refuse_long_memory(table, "", channel, study.controller.sample_time);
  for (const Mismatch& other : mismatches)
    if (other.cv == first.cv && other.input == first.input)
      table.refuse("", "a second mismatch of this channel", "every channel once");
  mismatches.insert(mismatches.end(), of_channel.begin(), of_channel.end());
}

OptionKeys sine_keys(Sine& sine) {
  return {
      key::number("amplitude", sine.amplitude, NumberRule::finite(), "half the distance from crest to trough",
                  "CV")
          .required(),
      key::number("period", sine.period, NumberRule::positive(), "2 pi over the angular frequency", "time")
          .required()};
}

OptionKeys ramp_keys(Ramp& ramp) {
  return {key::number("slope", ramp.slope, NumberRule::finite(), "slope of v", "CV / time").required(),
          key::number("start", ramp.start, NumberRule::at_least(0), "when it begins", "time")};
}

OptionKeys level_keys(StepSequence::Step& step, const StepSequence& before, int samples) {
  const auto read_sample = [&step, &before, samples](const TomlTable& table, const std::string& key) {
    step.sample = static_cast<int>(
        read_whole(table, key, before.steps.empty() ? 0 : before.steps.back().sample + 1, samples - 1));
  };
  return {key::option("sample", "whole number", "first sample with the new level", "samples")
              .required()
              .allow("above the one before it, at most `samples` - 1")
              .read(read_sample),
          key::number("level", step.level, NumberRule::finite(), "level from there on", "CV").required()};
}

/// The key of one form of a signal: a table with its numbers.
template <class Form>
OptionKey form_key(const char* name, DisturbanceSignal& signal, OptionKeys (*keys)(Form&),
                   const char* meaning) {
  const auto below = [keys] {
    Form form{};
    return keys(form);
  };
  return key::option(name, "table", meaning)
      .otherwise("none")
      .with("", below)
      .read([&signal, keys](const TomlTable& table, const std::string& key) {
        Form form{};
        const OptionKeys of_form = keys(form);
        read_keys(table.table(key, key_names(of_form)), of_form);
        signal = form;
      });
}

void refuse_two_signals(const TomlTable& table) {
  std::string first;
  for (const char* form : {"white", "sine", "ramp", "steps"}) {
    if (table.has(form) && !first.empty())
      table.refuse(form, fmt::format("{} beside {}", form, first), "one signal a disturbance");
    if (table.has(form))
      first = form;
  }
  if (table.has("hold") && !first.empty() && first != "white")
    table.refuse("hold", fmt::format("hold beside {}", first), "hold of a white signal");
}

OptionKeys signal_keys(DisturbanceSignal& signal, int samples) {
  const auto read_white = [&signal, samples](const TomlTable& table) {
    if (!table.has("sine") && !table.has("ramp") && !table.has("steps"))
      signal = WhiteNoise{.factor = read_number_or(table, "white", NumberRule::positive(), 1.0),
                          .hold = static_cast<int>(read_whole_or(table, "hold", 1, samples, 1))};
  };
  const auto take_step = [&signal](const TomlTable&, const StepSequence::Step& step) {
    if (!std::holds_alternative<StepSequence>(signal))
      signal = StepSequence{};
    std::get<StepSequence>(signal).steps.push_back(step);
  };
  const auto keys_of_step = [&signal, samples](StepSequence::Step& step) {
    static const StepSequence none;
    const auto* const before = std::get_if<StepSequence>(&signal);
    return level_keys(step, before == nullptr ? none : *before, samples);
  };
  return {key::check(refuse_two_signals),
          key::option("white", "number",
                      "v is white and normal, with `white` times the standard deviation "
                      "`disturbance.v_standard_deviation`",
                      "1")
              .otherwise("1")
              .allow("> 0"),
          key::option("hold", "whole number", "samples between new values of a white v", "samples")
              .otherwise("1")
              .allow("1 to `samples`"),
          form_key<Sine>("sine", signal, sine_keys, "v = amplitude sin(2 pi t / period)"),
          form_key<Ramp>("ramp", signal, ramp_keys, "v = slope (t - start) from t = start on"),
          key::list<StepSequence::Step>("steps", kMaxScenarios * kMaxScenarios, keys_of_step, take_step,
                                        "v is 0 at first and then stays at each level until the next step")
              .allow("one or more"),
          key::check(read_white)};
}

OptionKeys disturbance_model_keys() {
  return transfer_function_keys("v", "poles with negative real parts, or at 0");
}

/// Reads G_d of a disturbance. A first-order G_d is stored as its two numbers, like that of a random
/// disturbance.
void read_model(const TomlTable& table, double sample_time, Disturbance& disturbance) {
  const TransferFunction Gd = read_transfer_function(table).function;
  refuse_growing(table, Gd);
  refuse_long_memory(table, "dead_time", Gd, sample_time);
  if (table.has("gain") && Gd.dead_time() == 0) {
    disturbance.model = DisturbanceModel::first_order;
    disturbance.gain = read_number(table, "gain", NumberRule::finite());
    disturbance.time_constant = read_number(table, "time_constant", NumberRule::positive());
  } else {
    disturbance.model = DisturbanceModel::transfer_function;
    disturbance.Gd = Gd;
  }
}

OptionKeys disturbance_keys(Disturbance& disturbance, const Study& study) {
  disturbance = {.cv = -1, .gain = kNaN, .time_constant = kNaN, .model = DisturbanceModel::direct};
  const auto read_place = [&](const TomlTable& table) {
    if (table.has("cv") && table.has("input"))
      table.refuse("", "both cv and input", "exactly one of the two");
    if (table.has("input"))
      disturbance.inner_input = read_inner_input(table, study);
    else
      disturbance.cv = static_cast<Eigen::Index>(read_one_of(table, "cv", variable_names(study.plant.cvs)));
  };
  const auto read_Gd = [&](const TomlTable& table) {
    if (has_any(table, disturbance_model_keys()))
      read_model(table, study.controller.sample_time, disturbance);
    else if (!table.has("white") && !table.has("sine") && !table.has("ramp") && !table.has("steps"))
      table.refuse("", "neither a signal nor a transfer function", "at least one of the two");
  };
  const OptionKeys place{
      key::check(read_place),
      key::option("cv", "text", "CV that the disturbance is added to; several disturbances of a CV add up")
          .otherwise("this or `input`")
          .allow("name of a CV"),
      key::option("input", "text",
                  "inner input that the disturbance is added to, held over a sample; several disturbances of "
                  "an input add up")
          .otherwise("this or `cv`")
          .allow("inner input of a nonlinear plant ([plants.md](plants.md))")};
  return joined(joined(joined(place, disturbance_model_keys()),
                       signal_keys(disturbance.signal, study.simulation.samples)),
                {key::check(read_Gd)});
}

/// Refuses a scenario that must say which CVs are affected: a parameter or an inner input names no CV.
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

OptionKeys scenario_keys(Scenario& scenario, const Study& study) {
  const auto refuse_mismatch = [&study](const TomlTable& table) {
    if (study.nonlinear && table.has("mismatch"))
      table.refuse("mismatch", "channels of a plant that is simulated as nonlinear", "parameter");
  };
  return {
      key::name("name", scenario.name, "name in results").also("no two scenarios alike"),
      key::text("description", scenario.description, "one line for people").otherwise("empty"),
      key::list<ListedMismatch>(
          "mismatch", kMaxFaults, [&study](ListedMismatch& listed) { return mismatch_keys(listed, study); },
          [&](const TomlTable& table, ListedMismatch& listed) {
            take_mismatches(table, listed.mismatches, study, scenario.mismatches);
          },
          "channels of the plant that differ from the model")
          .allow("1 to 200; not for a nonlinear plant")
          .after(refuse_mismatch),
      parameter_changes_key(scenario.parameters, study),
      key::list<Disturbance>(
          "disturbance", kMaxFaults,
          [&study](Disturbance& disturbance) { return disturbance_keys(disturbance, study); },
          [&scenario](const TomlTable&, Disturbance& disturbance) {
            scenario.disturbances.push_back(std::move(disturbance));
          },
          "unmeasured disturbances")
          .allow("1 to 200"),
      key::option("affected", "list of texts",
                  "the truth: CVs that a diagnosis should flag. A CV that is listed without a fault of its "
                  "own is affected by the faults of the scenario")
          .otherwise("the CVs with a fault; required with a `parameter` or an inner `input`")
          .allow("names of CVs, none twice; `[]` for none"),
      key::check(
          [&](const TomlTable& table) { scenario.affected_cvs = read_affected(table, scenario, study); })};
}

}  // namespace

OptionKey scenarios_key(Study& study) {
  const auto take = [&study](const TomlTable& table, Scenario& scenario) {
    for (const Scenario& other : study.scenarios)
      if (other.name == scenario.name)
        table.refuse("name", fmt::format("'{}' for a second scenario", scenario.name), "every name once");
    study.scenarios.push_back(std::move(scenario));
  };
  return key::list<Scenario>(
             "scenario", kMaxScenarios,
             [&study](Scenario& scenario) { return scenario_keys(scenario, study); }, take,
             "the experiments of the study, spelled out")
      .otherwise("none: random experiments");
}

}  // namespace mpm
