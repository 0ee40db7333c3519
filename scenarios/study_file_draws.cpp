#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "plants/non_finite.hpp"
#include "scenarios/study_file_keys.hpp"
#include "scenarios/study_file_parts.hpp"
#include "scenarios/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxExperiments = 10'000'000;  // of one kind; the sum still is an int

bool all_zero(const auto& weights) {
  return std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; });
}

/// A table parameter_weights: all of the weights, or none of them.
template <std::size_t n>
void read_weights(const TomlTable& table, const std::array<std::string_view, n>& names,
                  std::array<double, n>& weights) {
  const NumberRule rule = NumberRule::at_least(0);
  for (std::size_t i = 0; i < n; ++i)
    weights[i] = table.is_there() ? read_number(table, names[i], rule)
                                  : read_number_or(table, names[i], rule, weights[i]);
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

ExperimentCounts read_experiments(const TomlTable& document, const Study& study) {
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
                                .tuning = count_or_none("tuning")};
  if (counts.total() == 0) {
    table.refuse("", "no experiment", "at least one of any kind");
  }
  if (study.nonlinear && counts.mpm + counts.mpm_ud > 0) {
    table.refuse(counts.mpm > 0 ? "mpm" : "mpm_ud",
                 "random mismatches of a plant that is simulated as nonlinear",
                 "0; its mismatches are named scenarios");
  }
  return counts;
}

MismatchRanges read_mismatch(const TomlTable& document, const PlantModel& plant) {
  const TomlTable table = document.table_or_empty("mismatch", study_file_keys("mismatch"));
  MismatchRanges ranges;
  const TomlTable weights =
      table.table_or_empty("parameter_weights", study_file_keys("mismatch.parameter_weights"));
  read_weights<3>(weights, {"gain", "time_constant", "dead_time"}, ranges.parameter_weight);
  if (all_zero(ranges.parameter_weight))
    weights.refuse("", "three weights of 0", "at least one > 0");
  ranges.gain_factor = read_distribution_or(table, "gain_factor", NumberRule::positive(), ranges.gain_factor);
  ranges.time_constant_factor = read_distribution_or(table, "time_constant_factor", NumberRule::positive(),
                                                     ranges.time_constant_factor);
  ranges.dead_time_shift =
      read_distribution_or(table, "dead_time_shift", NumberRule::finite(), ranges.dead_time_shift);
  refuse_impossible_shift(table, ranges.dead_time_shift, plant);
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
  return ranges;
}

TuningRanges read_tuning(const TomlTable& document, const Study& study) {
  const TomlTable table = document.table_or_empty("tuning", study_file_keys("tuning"));
  TuningRanges ranges;
  std::array<std::string_view, kTuningParameters.size()> names;
  std::transform(kTuningParameters.begin(), kTuningParameters.end(), names.begin(),
                 [](TuningParameter parameter) { return to_string(parameter); });
  read_weights(table.table_or_empty("parameter_weights", study_file_keys("tuning.parameter_weights")), names,
               ranges.parameter_weight);
  ranges.factor = read_distribution_or(table, "factor", NumberRule::positive(), ranges.factor);
  ranges.sensitivity = read_choice_or<TuningSensitivity>(
      table, "sensitivity", {{"current", TuningSensitivity::current}, {"design", TuningSensitivity::design}},
      ranges.sensitivity);
  if (study.experiments.tuning > 0 && all_zero(ranges.weights_for(study.controller)))
    table.refuse("parameter_weights", "a weight of 0 for everything that the controller has",
                 "at least one > 0");
  return ranges;
}

}  // namespace mpm
