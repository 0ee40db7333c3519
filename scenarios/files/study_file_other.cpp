// The keys of what begins in mid-record, and of the faults that are neither mismatch nor disturbance.

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {

OtherRanges read_other(const TomlTable& document, const Study& study) {
  const TomlTable table = document.table_or_empty("other", study_file_keys("other"));
  OtherRanges ranges;
  std::array<std::string_view, kOtherFaultKinds.size()> names;
  std::transform(kOtherFaultKinds.begin(), kOtherFaultKinds.end(), names.begin(),
                 [](OtherFaultKind kind) { return to_string(kind); });
  const TomlTable weights = table.table_or_empty("weights", study_file_keys("other.weights"));
  read_weights(weights, names, 0, ranges.weight);
  const auto read = [&table](const char* key, Distribution& range) {
    range = read_distribution_or(table, key, NumberRule::positive(), range);
  };
  read("sensor", ranges.sensor);
  read("valve", ranges.valve);
  read("jump", ranges.jump);
  read("md_gain", ranges.md_gain);
  read("md_noise", ranges.md_noise);
  read("limit", ranges.limit);
  ranges.impact = read_impact(table);
  if (study.experiments.other == 0)
    return ranges;
  Study with_ranges = study;
  with_ranges.other = ranges;
  const auto possible = other_weights(with_ranges);
  if (std::all_of(possible.begin(), possible.end(), [](double weight) { return weight == 0.0; }))
    weights.refuse("", "a weight of 0 for everything that the loops can have", "at least one > 0");
  return ranges;
}

OnsetRanges read_onset(const TomlTable& document, const Study& study) {
  const TomlTable table = document.table_or_empty("onset", study_file_keys("onset"));
  OnsetRanges ranges;
  const NumberRule rule = NumberRule::at_least(0);
  ranges.sample = read_distribution_or(table, "sample", rule, ranges.sample);
  ranges.growth = read_distribution_or(table, "growth", rule, ranges.growth);
  const int samples = study.simulation.samples;
  if (ranges.sample.maximum() >= samples)
    table.refuse("sample", fmt::format("draws up to {}", ranges.sample.maximum()),
                 fmt::format("draws below {}, the samples of the record", samples));
  if (study.nonlinear && ranges.growth.maximum() > 0.0)
    table.refuse("growth", "a gradual onset",
                 "{constant = 0}: the parameters of a nonlinear plant change at once");
  return ranges;
}

}  // namespace mpm
