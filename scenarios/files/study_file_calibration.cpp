#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/study/window_scan.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxCalibrationLoops = 1'000'000;  // of one kind
constexpr std::int64_t kShortestMonitoringWindow = kShortestWindow + kFewestCorrelatedPairs;
constexpr std::int64_t kLargestCalibrationSeed = std::numeric_limits<std::int64_t>::max();

/// Loops of the same seed would be those that the thresholds are tried on.
std::uint64_t read_calibration_seed(const TomlTable& table, const Study& study) {
  const auto seed = static_cast<std::uint64_t>(read_whole(table, "seed", 0, kLargestCalibrationSeed));
  if (seed == study.seed)
    table.refuse("seed", fmt::format("{}, the seed of the study", seed), "another one");
  return seed;
}

}  // namespace

std::optional<MonitoringOptions> read_monitoring(const TomlTable& document, const Study& study) {
  if (!document.has("monitoring"))
    return std::nullopt;
  const TomlTable table = document.table("monitoring", study_file_keys("monitoring"));
  if (study.names_scenarios())
    table.refuse("", "monitoring of a study of named scenarios", "only in a study of random experiments");
  const std::int64_t samples = study.simulation.samples;
  MonitoringOptions options;
  options.window = static_cast<int>(read_whole_or(table, "window",
                                                  std::min<std::int64_t>(kShortestMonitoringWindow, samples),
                                                  samples, std::min<std::int64_t>(options.window, samples)));
  options.stride = static_cast<int>(
      read_whole_or(table, "stride", 1, samples, std::min<std::int64_t>(options.stride, samples)));
  return options;
}

std::optional<CalibrationOptions> read_calibration(const TomlTable& document, const Study& study) {
  if (!document.has("calibration"))
    return std::nullopt;
  const TomlTable table = document.table("calibration", study_file_keys("calibration"));
  if (study.names_scenarios())
    table.refuse("", "calibration of a study of named scenarios", "only in a study of random experiments");
  CalibrationOptions options;
  options.false_alarms =
      read_number_or(table, "false_alarms", NumberRule::inside(0, 1), options.false_alarms);
  options.healthy =
      static_cast<int>(read_whole_or(table, "healthy", 1, kMaxCalibrationLoops, options.healthy));
  options.ud = static_cast<int>(read_whole_or(table, "ud", 0, kMaxCalibrationLoops, options.ud));
  if (table.has("seed"))
    options.seed = read_calibration_seed(table, study);
  return options;
}

}  // namespace mpm
