#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/gate.hpp"
#include "analysis/findings/method_rates.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {

/// Whether a run passes with a gate that is shown neither to hold nor to fail.
enum class InconclusivePolicy { fail, pass };

/// [baseline]: an earlier run, and how far the verdicts may fall behind it.
struct BaselineLimits {
  std::filesystem::path archive;  ///< path of an archive, or of a folder or board of a suite
  /// Smallest p-value (BaselineChanges::p_worse) of lost and gained verdicts that does not count as a
  /// regression.
  double significance = 0.05;
  std::optional<std::int64_t> maximum_lost;  ///< lost verdicts per question; none: no limit
};

/// A gate file (docs/gates.md).
struct GateFile {
  InconclusivePolicy inconclusive = InconclusivePolicy::fail;
  std::optional<double> confidence;  ///< confidence level of the intervals; none: that of the study
  std::int64_t maximum_failed = 0;   ///< experiments without a result
  std::int64_t minimum_experiments = 1;
  double minimum_answered = kFewestAnswers;  ///< share of the loops on which a method from outside was asked
  std::vector<Gate> gates;
  std::optional<BaselineLimits> baseline;
};

/// All tables of the gate file with their keys, for the manual. They are named like those of the study file.
std::vector<KeyTable> gate_file_tables();

/// Reads gates on the `findings` from the text of a gate file. `file_name` is for messages; relative paths in
/// the text are relative to its folder.
GateFile parse_gates(std::string_view text, const std::string& file_name,
                     const std::vector<Finding>& findings);

/// Reads a gate file. Errors: as parse_gates(), and InputError if the file cannot be read.
GateFile load_gates(const std::filesystem::path& path, const std::vector<Finding>& findings);

}  // namespace mpm
