#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "plants/non_finite.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxExperiments = 10'000'000;  // of one kind; the sum still is an int

template <std::size_t n, class Enum>
std::array<std::string_view, n> names_of(const std::array<Enum, n>& values) {
  std::array<std::string_view, n> names;
  std::transform(values.begin(), values.end(), names.begin(), [](Enum value) { return to_string(value); });
  return names;
}

/// The table of weights under `key`, one a value of `of`.
template <std::size_t n, class Enum>
void read_weights_of(const TomlTable& parent, const std::string& key, const std::string& path,
                     const std::array<Enum, n>& of, std::size_t required, std::array<double, n>& weights) {
  const TomlTable table = parent.table_or_empty(key, study_file_keys(path));
  read_weights(table, names_of(of), required, weights);
  refuse_no_weight(table, weights);
}

/// Smallest dead time of the channels that a mismatch can change.
double shortest_dead_time(const PlantModel& plant) {
  double shortest = kInfinity;
  for (Eigen::Index row = 0; row < plant.G.rows(); ++row) {
    for (std::size_t mv = 0; mv < plant.mvs.size(); ++mv) {
      const TransferFunction& channel = plant.G(row, static_cast<Eigen::Index>(mv));
      if (!channel.is_zero()) {
        shortest = std::min(shortest, channel.dead_time());
      }
    }
  }
  return shortest;
}

/// In each channel some draw must leave a dead time >= 0, since draws are confined to those that do.
void refuse_impossible_shift(const TomlTable& mismatch, const Distribution& shift, const PlantModel& plant) {
  const double lowest = -shortest_dead_time(plant);
  const bool constant = shift.kind() == Distribution::Kind::constant;
  if (constant ? shift.maximum() < lowest : shift.maximum() <= lowest) {
    mismatch.refuse("dead_time_shift", fmt::format("draws of at most {}", shift.maximum()),
                    fmt::format("draws that can be {} {}: the shortest dead time is {}",
                                constant ? ">=" : ">", lowest, -lowest));
  }
}

}  // namespace

ExperimentCounts read_experiments(const TomlTable& document) {
  if (document.has("scenario")) {
    for (const char* random : {"experiments", "mismatch", "tuning"}) {
      if (document.has(random)) {
        document.refuse(random, "random experiments beside named scenarios", "one of the two");
      }
    }
    return {};
  }
  const TomlTable table = document.table("experiments", study_file_keys("experiments"));
  const auto count = [&table](const char* key) {
    return static_cast<int>(read_whole(table, key, 0, kMaxExperiments));
  };
  const auto count_or_none = [&table](const char* key) {
    return static_cast<int>(read_whole_or(table, key, 0, kMaxExperiments, 0));
  };
  const ExperimentCounts counts{.mpm = count("mpm"),
                                .ud = count("ud"),
                                .mpm_ud = count("mpm_ud"),
                                .healthy = count_or_none("healthy"),
                                .tuning = count_or_none("tuning"),
                                .other = count_or_none("other")};
  if (counts.total() == 0) {
    table.refuse("", "no experiment", "at least one of any kind");
  }
  return counts;
}

void read_weights(const TomlTable& table, std::span<const std::string_view> names, std::size_t required,
                  std::span<double> weights) {
  const NumberRule rule = NumberRule::at_least(0);
  for (std::size_t i = 0; i < names.size(); ++i)
    weights[i] = table.is_there() && i < required
                     ? read_number(table, names[i], rule)
                     : read_number_or(table, names[i], rule, table.is_there() ? 0.0 : weights[i]);
}

void refuse_no_weight(const TomlTable& table, std::span<const double> weights) {
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; }))
    table.refuse("", "weights that are all 0", "at least one > 0");
}

SignalSequence read_sequence_or(const TomlTable& table, SignalSequence otherwise) {
  return read_choice_or<SignalSequence>(
      table, "sequence", {{"each", SignalSequence::each}, {"shared", SignalSequence::shared}}, otherwise);
}

std::optional<Distribution> read_impact(const TomlTable& table) {
  if (!table.has("impact"))
    return std::nullopt;
  return read_distribution(table, "impact", NumberRule::positive());
}

MismatchRanges read_mismatch(const TomlTable& document, const Study& study) {
  const TomlTable table = document.table_or_empty("mismatch", study_file_keys("mismatch"));
  MismatchRanges ranges;
  constexpr std::size_t kClassic = 3;  // those of table 6.4, without which the others do not stand
  read_weights_of(table, "parameter_weights", "mismatch.parameter_weights", kRandomMismatchParameters,
                  kClassic, ranges.parameter_weight);
  read_weights_of(table, "extent_weights", "mismatch.extent_weights", kMismatchExtents, 0,
                  ranges.extent_weight);
  ranges.gain_factor = read_distribution_or(table, "gain_factor", NumberRule::positive(), ranges.gain_factor);
  ranges.time_constant_factor = read_distribution_or(table, "time_constant_factor", NumberRule::positive(),
                                                     ranges.time_constant_factor);
  ranges.dead_time_shift =
      read_distribution_or(table, "dead_time_shift", NumberRule::finite(), ranges.dead_time_shift);
  refuse_impossible_shift(table, ranges.dead_time_shift, study.plant);
  ranges.second_order =
      read_distribution_or(table, "second_order", NumberRule::positive(), ranges.second_order);
  ranges.inverse_response =
      read_distribution_or(table, "inverse_response", NumberRule::positive(), ranges.inverse_response);
  ranges.impact = read_impact(table);
  ranges.plant_parameters = read_plant_parameters(table, study);
  return ranges;
}

DisturbanceRanges read_disturbance(const TomlTable& document) {
  const TomlTable table = document.table_or_empty("disturbance", study_file_keys("disturbance"));
  DisturbanceRanges ranges;
  ranges.gain = read_distribution_or(table, "gain", NumberRule::positive(), ranges.gain);
  ranges.time_constant =
      read_distribution_or(table, "time_constant", NumberRule::positive(), ranges.time_constant);
  ranges.v_standard_deviation =
      read_number_or(table, "v_standard_deviation", NumberRule::positive(), ranges.v_standard_deviation);
  ranges.sequence = read_sequence_or(table, ranges.sequence);
  read_weights_of(table, "signal_weights", "disturbance.signal_weights", kDisturbanceShapes, 0,
                  ranges.signal_weight);
  read_weights_of(table, "place_weights", "disturbance.place_weights", kDisturbancePlaces, 0,
                  ranges.place_weight);
  ranges.impact = read_impact(table);
  return ranges;
}

TuningRanges read_tuning(const TomlTable& document, const Study& study) {
  const TomlTable table = document.table_or_empty("tuning", study_file_keys("tuning"));
  TuningRanges ranges;
  read_weights(table.table_or_empty("parameter_weights", study_file_keys("tuning.parameter_weights")),
               names_of(kTuningParameters), kTuningParameters.size(), ranges.parameter_weight);
  ranges.factor = read_distribution_or(table, "factor", NumberRule::positive(), ranges.factor);
  ranges.sensitivity = read_choice_or<TuningSensitivity>(
      table, "sensitivity", {{"current", TuningSensitivity::current}, {"design", TuningSensitivity::design}},
      ranges.sensitivity);
  const auto weights = ranges.weights_for(study.controller);
  if (study.experiments.tuning > 0 &&
      std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; }))
    table.refuse("parameter_weights", "a weight of 0 for everything that the controller has",
                 "at least one > 0");
  return ranges;
}

}  // namespace mpm
