#include <cstdint>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr double kMostOutliers = 0.5;  // beyond it the others are the outliers

/// A gap begins with a probability of at most 1 after each sample that is there.
double largest_missing_share(double length) {
  return length / (length + 1.0);
}

void read_outliers(const TomlTable& record, RecordOptions& options) {
  const TomlTable table = record.table("outliers", study_file_keys("record.outliers"));
  options.outlier_share = read_number(
      table, "share", {.low = 0, .high = kMostOutliers, .low_included = false, .high_included = true});
  options.outlier_size = read_distribution_or(table, "size", NumberRule::positive(), options.outlier_size);
}

void read_missing(const TomlTable& record, RecordOptions& options) {
  const TomlTable table = record.table("missing", study_file_keys("record.missing"));
  options.missing_length = read_number_or(table, "length", NumberRule::at_least(1), options.missing_length);
  options.missing_share = read_number(table, "share", NumberRule::inside(0, 1));
  if (const double largest = largest_missing_share(options.missing_length); options.missing_share > largest)
    table.refuse("share", fmt::format("{}", options.missing_share),
                 fmt::format("at most {:.3g} with gaps of {} samples: a sample stands between two gaps",
                             largest, options.missing_length));
  options.fill = read_gap_fill_or(table, "fill", options.fill);
}

void read_candidates(const TomlTable& record, RecordOptions& options) {
  const TomlTable table = record.table("candidates", study_file_keys("record.candidates"));
  options.candidates = static_cast<int>(read_whole(table, "count", 1, RecordOptions::kMostCandidates));
  options.candidate_share =
      read_number_or(table, "share", {.low = 0, .high = 1, .low_included = true, .high_included = true},
                     options.candidate_share);
}

/// Sizes are in standard deviations of the noise: without noise they would all be 0.
void refuse_without_noise(const TomlTable& record, const Study& study) {
  const Eigen::VectorXd& noise = study.simulation.noise_standard_deviation;
  for (const char* key : {"outliers", "quantisation", "compression"})
    for (Eigen::Index cv = 0; cv < noise.size(); ++cv)
      if (record.has(key) && noise(cv) == 0.0)
        record.refuse(key,
                      fmt::format("sizes in standard deviations of the noise, which is 0 for {}",
                                  study.plant.cvs[static_cast<std::size_t>(cv)].name),
                      "simulation.noise_standard_deviation > 0 for every CV");
}

}  // namespace

GapFill read_gap_fill_or(const TomlTable& table, std::string_view key, GapFill fallback) {
  return read_choice_or<GapFill>(
      table, key, {{"none", GapFill::none}, {"hold", GapFill::hold}, {"linear", GapFill::linear}}, fallback);
}

RecordOptions read_record(const TomlTable& document, const Study& study) {
  RecordOptions options;
  if (!document.has("record"))
    return options;
  const TomlTable table = document.table("record", study_file_keys("record"));
  if (table.has("outliers"))
    read_outliers(table, options);
  if (table.has("missing"))
    read_missing(table, options);
  if (table.has("candidates"))
    read_candidates(table, options);
  options.quantisation = read_number_or(table, "quantisation", NumberRule::at_least(0), options.quantisation);
  options.compression = read_number_or(table, "compression", NumberRule::at_least(0), options.compression);
  refuse_without_noise(table, study);
  return options;
}

}  // namespace mpm
