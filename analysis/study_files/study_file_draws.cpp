// [experiments] and the distributions from which random experiments are drawn.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/transfer_function_keys.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxExperiments = 10'000'000;  // of one kind; the sum of all kinds is still an int

/// A table that only a study of random experiments has.
OptionKey random_table(const char* name, std::function<OptionKeys()> below, const char* meaning) {
  OptionKey made = key::table(name, std::move(below), meaning);
  made.reader = [read = std::move(made.reader)](const TomlTable& document, const OptionKey& key) {
    if (!document.has("scenario"))
      read(document, key);
  };
  return made;
}

/// The key of the size of an effect (FaultScales).
OptionKey impact_key(std::optional<Distribution>& impact, const char* meaning, const char* unit) {
  return key::option("impact", "distribution", meaning, unit)
      .otherwise("none: sizes as drawn")
      .allow("draws > 0")
      .read([&impact](const TomlTable& table, const std::string& key) {
        impact = read_distribution(table, key, NumberRule::positive());
      });
}

/// Relative frequencies of the values of `of`, each with its meaning. The frequencies after the first
/// `required` may be left out.
template <std::size_t n, class Enum>
OptionKey weights_key(const char* name, const std::array<Enum, n>& of, std::size_t required,
                      std::array<double, n>& weights, const std::vector<const char*>& meanings,
                      const char* meaning) {
  OptionKeys keys;
  for (std::size_t i = 0; i < n; ++i)
    keys.push_back(key::option(std::string(to_string(of[i])), "number", meanings[i]));
  return key::weights(name, std::move(keys), required, weights.data(), meaning);
}

bool all_zero(std::span<const double> weights) {
  return std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; });
}

/// Refuses the table of weights under `key` if all of them are 0.
OptionKey refuse_no_weight(const char* key, std::span<const double> weights) {
  return key::check([key, weights](const TomlTable& table) {
    if (all_zero(weights))
      table.refuse(key, "weights that are all 0", "at least one > 0");
  });
}

OptionKeys experiments_keys(ExperimentCounts& counts) {
  const auto count = [](const char* name, int& value, const char* meaning) {
    return key::whole(name, value, 0, kMaxExperiments, meaning);
  };
  return {
      count("mpm", counts.mpm,
            "experiments with a model-plant mismatch; a nonlinear plant needs `mismatch.plant_parameter` for "
            "them")
          .required(),
      count("ud", counts.ud, "experiments with an unmeasured disturbance").required(),
      count("mpm_ud", counts.mpm_ud, "experiments with both on one CV").required(),
      count("healthy", counts.healthy,
            "experiments without a fault; each has its own noise and the same excitation as all others"),
      count("tuning", counts.tuning,
            "experiments in which model and plant agree and one weight of the controller is changed"),
      count("other", counts.other,
            "experiments with a fault outside of the model: a sensor, a valve, a limit, an operator "
            "(`other`). At least one of the six counts is above 0"),
      key::check([&counts](const TomlTable& table) {
        if (counts.total() == 0)
          table.refuse("", "no experiment", "at least one of any kind");
      })};
}

/// Returns the smallest dead time of the channels that a mismatch can change.
double shortest_dead_time(const Study& study) {
  double shortest = kInfinity;
  for (const auto& [cv, mv] : mismatch_channels(study))
    shortest = std::min(shortest, study.plant.G(cv, mv).dead_time());
  return shortest;
}

/// "level/hot"
std::string channel_text(const Study& study, const ChannelPlace& place) {
  return fmt::format("{}/{}", study.plant.cvs[static_cast<std::size_t>(place.first)].name,
                     study.plant.mvs[static_cast<std::size_t>(place.second)].name);
}

OptionKey mismatch_channels_key(Study& study) {
  const auto read = [&study](const TomlTable& table, const std::string& key) {
    if (study.nonlinear)
      table.refuse(key, "channels of a plant that is not simulated with its linear model", "plant_parameter");
    const std::vector<ChannelPlace> channels = mv_channels(study);
    std::vector<std::string> names;
    for (const ChannelPlace& place : channels)
      names.push_back(channel_text(study, place));
    for (const std::size_t place : read_some_of(table, key, names))
      study.mismatch.channels.push_back(channels[place]);
    std::sort(study.mismatch.channels.begin(), study.mismatch.channels.end());
  };
  return key::option("channels", "list of texts",
                     "channels that mismatches of any extent change, written as `CV/MV`: `[\"y1/u1\"]`")
      .otherwise("every channel from an MV")
      .allow("channels of the model, none twice; not for a nonlinear plant")
      .read(read);
}

/// Sorts the disturbed CVs. In an experiment with both faults the disturbance is on the CV of the mismatch,
/// so every CV that a mismatch can affect must be among them.
void check_disturbed_cvs(const TomlTable& table, Study& study) {
  std::vector<Eigen::Index>& cvs = study.disturbance.cvs;
  std::sort(cvs.begin(), cvs.end());
  if (cvs.empty() || study.nonlinear || study.experiments.mpm_ud == 0)
    return;
  for (const ChannelPlace& place : mismatch_channels(study))
    if (!std::binary_search(cvs.begin(), cvs.end(), place.first))
      table.refuse("cvs",
                   fmt::format("no '{}', on which `mpm_ud` experiments have a mismatch and its disturbance",
                               study.plant.cvs[static_cast<std::size_t>(place.first)].name),
                   "every CV of mismatch.channels, or mpm_ud = 0");
}

/// Refuses shifts of which no draw leaves a dead time >= 0 in some channel, since only draws that do are
/// used.
void refuse_impossible_shift(const TomlTable& mismatch, const Study& study) {
  const Distribution& shift = study.mismatch.dead_time_shift;
  const double lowest = -shortest_dead_time(study);
  const bool constant = shift.kind() == Distribution::Kind::constant;
  if (constant ? shift.maximum() < lowest : shift.maximum() <= lowest) {
    mismatch.refuse("dead_time_shift", fmt::format("draws of at most {}", shift.maximum()),
                    fmt::format("draws that can be {} {}: the shortest dead time is {}",
                                constant ? ">=" : ">", lowest, -lowest));
  }
}

/// Refuses draws with which a channel looks back over too many samples, because they take memory of the
/// program.
void refuse_long_channels(const TomlTable& mismatch, const Study& study) {
  const MismatchRanges& ranges = study.mismatch;
  if (study.nonlinear || study.experiments.mpm + study.experiments.mpm_ud == 0)
    return;
  for (const ChannelPlace& place : mismatch_channels(study)) {
    const TransferFunction& channel = study.plant.G(place.first, place.second);
    LongestDraws longest;
    const auto check = [&](const char* key, const Distribution& draws) {
      refuse_long_draws(mismatch, key, draws, channel, channel_text(study, place), longest,
                        study.controller.sample_time);
    };
    longest.dead_time_shift = largest_draw(ranges.dead_time_shift);
    check("dead_time_shift", ranges.dead_time_shift);
    longest.time_factor = largest_draw(ranges.time_constant_factor);
    check("time_constant_factor", ranges.time_constant_factor);
    // A further lag comes alone.
    for (const auto& [key, parameter, draws] :
         {std::tuple("second_order", MismatchParameter::second_order, &ranges.second_order),
          {"inverse_response", MismatchParameter::inverse_response, &ranges.inverse_response}}) {
      const auto drawn =
          std::find(kRandomMismatchParameters.begin(), kRandomMismatchParameters.end(), parameter) -
          kRandomMismatchParameters.begin();
      if (ranges.parameter_weight[static_cast<std::size_t>(drawn)] == 0.0)
        continue;
      longest = {.lag = largest_draw(*draws) *
                        std::max(std::abs(channel.residence_time()), study.controller.sample_time)};
      check(key, *draws);
    }
  }
}

OptionKeys mismatch_ranges_keys(Study& study) {
  MismatchRanges& ranges = study.mismatch;
  constexpr std::size_t kClassic = 3;  // those of table 6.4, required with any of the others
  const NumberRule positive = NumberRule::positive();
  return {
      mismatch_channels_key(study),
      weights_key("parameter_weights", kRandomMismatchParameters, kClassic, ranges.parameter_weight,
                  {"relative frequency; they need not sum to 1", "the same", "the same",
                   "relative frequency of a further lag", "relative frequency of a right-half-plane zero",
                   "relative frequency of a gain with the opposite sign"},
                  "relative frequencies of the changed parameters")
          .otherwise("1 for the three of table 6.4"),
      refuse_no_weight("parameter_weights", ranges.parameter_weight),
      weights_key(
          "extent_weights", kMismatchExtents, 0, ranges.extent_weight,
          {"relative frequency of one parameter of one channel",
           "the same for gain, time constant and dead time of one channel, each drawn",
           "the same for one parameter of every channel from an MV to one CV, each by its own amount",
           "the same for the gain of every channel of an MV, all by one factor: a fault of its actuator",
           "the same for one parameter of every channel from an MV, each by its own amount: a drift"},
          "relative frequencies of the extents of a mismatch")
          .otherwise("`parameter` alone"),
      refuse_no_weight("extent_weights", ranges.extent_weight),
      key::distribution("gain_factor", ranges.gain_factor, positive,
                        "factor of the gain. A factor of 0 would remove the channel; a negative one would "
                        "reverse the sign of the loop",
                        "1"),
      key::distribution("time_constant_factor", ranges.time_constant_factor, positive,
                        "factor of the time constants", "1"),
      key::distribution("dead_time_shift", ranges.dead_time_shift, NumberRule::finite(),
                        "added to the dead time; only shifts that leave it >= 0 are drawn", "time")
          .allow("the upper end above minus the shortest dead time"),
      key::check([&study](const TomlTable& table) { refuse_impossible_shift(table, study); }),
      key::distribution("second_order", ranges.second_order, positive,
                        "time constant T of a further lag, G / (T s + 1), over the residence time of the "
                        "channel, which is at least a sample (for a first-order channel, its time constant)",
                        "1"),
      key::distribution("inverse_response", ranges.inverse_response, positive,
                        "T of a right-half-plane zero, G (1 - T s) / (1 + T s), over the residence time",
                        "1"),
      key::check([&study](const TomlTable& table) { refuse_long_channels(table, study); }),
      impact_key(ranges.impact, "effect to which every mismatch is scaled (see below)", "1"),
      plant_parameters_key(ranges.plant_parameters, study)};
}

OptionKeys disturbance_ranges_keys(Study& study) {
  DisturbanceRanges& ranges = study.disturbance;
  const NumberRule positive = NumberRule::positive();
  return {
      key::some_of(
          "cvs", ranges.cvs, [&study] { return variable_names(study.plant.cvs); },
          "CVs on which disturbances act; a disturbance on an MV (`place_weights`) reaches all CVs of the MV")
          .otherwise("every CV")
          .allow(
              "names of CVs, none twice; with `mpm_ud` experiments those of `mismatch.channels` among them"),
      key::check([&study](const TomlTable& table) { check_disturbed_cvs(table, study); }),
      key::distribution("gain", ranges.gain, positive,
                        "static gain; its sign would change nothing, because v is symmetric", "CV"),
      key::distribution("time_constant", ranges.time_constant, positive, "time constant", "time"),
      key::number("v_standard_deviation", ranges.v_standard_deviation, positive,
                  "standard deviation of v, which is held over a sample. Open in the thesis; 1 gives its "
                  "share of infeasible experiments",
                  "1"),
      sequence_key(
          ranges.sequence,
          "`\"each\"`: every experiment draws its own v. `\"shared\"`: all have the same v, drawn once for "
          "the study, like a random block with a fixed seed. Open: table 6.4 draws the CV and G_d, not v"),
      weights_key(
          "signal_weights", kDisturbanceShapes, 0, ranges.signal_weight,
          {"relative frequency of white noise: y_d is filtered noise, slow or fast as `time_constant` says",
           "the same for one step, up or down, between 10 and 60 % of the record",
           "the same for a ramp that begins in the same part of the record and goes on to its end",
           "the same for summed white noise",
           "the same for a sine with a period of 8 samples to a quarter of the record",
           "the same for white noise in bursts of 20 samples with 80 samples between them, on average"},
          "relative frequencies of the shapes of v")
          .otherwise("`white` alone"),
      refuse_no_weight("signal_weights", ranges.signal_weight),
      weights_key("place_weights", kDisturbancePlaces, 0, ranges.place_weight,
                  {"relative frequency of one CV; in an experiment with a mismatch, the CV of the mismatch",
                   "the same for an MV on its way to the plant, invisible to controller and record; `gain` "
                   "counts at the CV with the largest gain from this MV",
                   "the same for two or three CVs, each through its own G_d from the same v"},
                  "relative frequencies of the places where a disturbance acts")
          .otherwise("`cv` alone"),
      refuse_no_weight("place_weights", ranges.place_weight),
      impact_key(ranges.impact, "effect to which every disturbance is scaled, as for a mismatch", "1")};
}

OptionKeys tuning_keys(Study& study) {
  TuningRanges& ranges = study.tuning;
  const auto refuse_no_tuning = [&study](const TomlTable& table) {
    if (study.experiments.tuning > 0 && all_zero(study.tuning.weights_for(study.controller)))
      table.refuse("parameter_weights", "a weight of 0 for everything that the controller has",
                   "at least one > 0");
  };
  return {weights_key(
              "parameter_weights", kTuningParameters, kTuningParameters.size(), ranges.parameter_weight,
              {"relative frequency of a change of the move suppression of an MV; the four need not sum to 1",
               "the same for MVs with a target", "the same for CVs with a soft limit",
               "the same for CVs with a setpoint"},
              "relative frequencies of the changed parameters")
              .otherwise("all 1")
              .allow("with bad tunings, above 0 for a weight that the controller has"),
          key::distribution("factor", ranges.factor, NumberRule::positive(),
                            "factor of the weight as the study writes it, whatever `weight_convention` says",
                            "1"),
          key::choice("sensitivity", ranges.sensitivity, {"current", "design"},
                      "controller whose S0 is used in the diagnosis of the experiment. `\"current\"`: the "
                      "controller that runs, since S0 belongs to the controller and is determined again when "
                      "its tuning changes (appendix A2, scenario 4 of chapter 4). `\"design\"`: the "
                      "controller of the study, as if nobody had noticed the change"),
          key::check(refuse_no_tuning)};
}

std::vector<const char*> other_fault_meanings() {
  std::vector<const char*> meanings;
  for (const OtherFaultKind kind : kOtherFaultKinds)
    meanings.push_back(info_of(kind).meaning);
  return meanings;
}

OptionKeys other_keys(Study& study) {
  OtherRanges& ranges = study.other;
  const NumberRule positive = NumberRule::positive();
  const auto refuse_no_fault = [&study](const TomlTable& table) {
    if (study.experiments.other > 0 && all_zero(other_weights(study)))
      table.refuse("weights", "a weight of 0 for everything that the loops can have", "at least one > 0");
  };
  return {
      weights_key("weights", kOtherFaultKinds, 0, ranges.weight, other_fault_meanings(),
                  "relative frequencies of the kinds")
          .otherwise("all 1")
          .allow("some kind > 0 that the loops can have"),
      key::distribution("sensor", ranges.sensor, positive,
                        "bias, or drift at the end of the record, over the standard deviation of the noise "
                        "(over 1 without noise), with either sign",
                        "1"),
      key::distribution("valve", ranges.valve, positive,
                        "S, d or f_S of a valve over the range of the hard limits of its MV (1 without them)",
                        "1"),
      key::choice(
          "valve_start", ranges.valve_start,
          "where the stem stands if a valve sticks from the first sample on. `\"signal\"`: at its signal. "
          "`\"unknown\"`: anywhere that it can stand under this signal, drawn for each experiment"),
      key::distribution("jump", ranges.jump, positive,
                        "J over S of `stiction`, and (f_S - f_D) over f_S of `friction`, at most 1 there",
                        "1"),
      key::distribution("md_gain", ranges.md_gain, positive, "factor of the measurement of an MD", "1"),
      key::distribution("md_noise", ranges.md_noise, positive, "standard deviation of white noise on it",
                        "MD"),
      key::distribution("limit", ranges.limit, positive,
                        "shift of both soft limits of a CV over its range (over 1 if a side has no limit), "
                        "with either sign",
                        "1"),
      impact_key(ranges.impact,
                 "effect to which every fault is scaled, as for a mismatch; a held MV has no size", "1"),
      key::check(refuse_no_fault)};
}

OptionKeys onset_keys(Study& study) {
  OnsetRanges& ranges = study.onset;
  const auto check_onset = [&study](const TomlTable& table) {
    if (study.onset.sample.maximum() >= study.simulation.samples)
      table.refuse("sample", fmt::format("draws up to {}", study.onset.sample.maximum()),
                   fmt::format("draws below {}, the samples of the record", study.simulation.samples));
    if (study.nonlinear && study.onset.growth.maximum() > 0.0)
      table.refuse("growth", "a gradual onset",
                   "{constant = 0}: the parameters of a nonlinear plant change at once");
  };
  return {key::distribution("sample", ranges.sample, NumberRule::at_least(0),
                            "sample at which they begin, rounded down", "samples")
              .allow("draws >= 0 and below `simulation.samples`"),
          key::distribution("growth", ranges.growth, NumberRule::at_least(0),
                            "number of samples over which they grow linearly; a growth as long as the record "
                            "is a drift. Valves, limits and held MVs change at once",
                            "samples")
              .allow("draws >= 0; `{constant = 0}` for a nonlinear plant"),
          key::check(check_onset)};
}

}  // namespace

OptionKey sequence_key(SignalSequence& sequence, std::string meaning) {
  return key::choice("sequence", sequence, {"each", "shared"}, std::move(meaning));
}

OptionKey experiments_key(Study& study) {
  const auto refuse_beside_scenarios = [](const TomlTable& document) {
    for (const char* random : {"experiments", "mismatch", "tuning"})
      if (document.has("scenario") && document.has(random))
        document.refuse(random, "random experiments beside named scenarios", "one of the two");
  };
  return random_table(
             "experiments", [&study] { return experiments_keys(study.experiments); },
             "how many random experiments of each kind")
      .required()
      .otherwise("required, unless there are scenarios")
      .after(refuse_beside_scenarios);
}

OptionKeys fault_keys(Study& study) {
  return {random_table(
              "mismatch", [&study] { return mismatch_ranges_keys(study); },
              "ranges of the random model-plant mismatches"),
          key::table(
              "disturbance", [&study] { return disturbance_ranges_keys(study); },
              "ranges of the random unmeasured disturbances"),
          random_table(
              "tuning", [&study] { return tuning_keys(study); }, "ranges of the random bad tunings"),
          random_table(
              "other", [&study] { return other_keys(study); },
              "ranges of the random faults of instruments, valves, limits and operators"),
          random_table(
              "onset", [&study] { return onset_keys(study); }, "when the faults of a random experiment begin")
              .otherwise("from the start")};
}

}  // namespace mpm
