#include "analysis/study_files/resolved_study.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "analysis/study_files/study_file_keys.hpp"
#include "analysis/study_files/study_file_parts.hpp"
#include "base/error.hpp"
#include "scenarios/toml/toml_draft.hpp"

namespace mpm {

namespace {

/// Keys that were added later. The default of each is what studies without the key do. Append new ones at the
/// end.
constexpr std::array kLaterKeys{"diagnosis.impact",           "other.valve_start",
                                "other.weights.sensor_stuck", "other.weights.stick_slip",
                                "other.weights.friction",     "record.sampling",
                                "record.exception",           "world.valve_curvature",
                                "world.background.swell",     "assessment.likelihood.judged",
                                "world.repair_screen",        "assessment.lasso.penalty",
                                "assessment.yu-qin.limits"};

TomlDraft resolved_draft(const Study& study) {
  TomlDraft draft(key_names(study_file_keys("")));
  Study read = read_study(study.source, study.name, study.assessment.table, &draft);
  read.seed = study.seed;
  read.methods = study.methods;
  if (read != study)
    throw InputError(fmt::format("defaults of the study '{}'", study.name),
                     "a study that was changed after it was read",
                     "a study as its text says it, with any seed and methods");
  TomlDraft& heading = draft.table("study", key_names(study_file_keys("study")));
  constexpr std::int64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();
  if (study.seed <= static_cast<std::uint64_t>(kLargestSeed))
    heading.set("seed", static_cast<std::int64_t>(study.seed));
  else
    heading.comment("seed", fmt::format("{}, above what a study file can say, {}", study.seed, kLargestSeed));
  draft.table("methods", key_names(study_file_keys("methods"))).set("names", study.methods);
  return draft;
}

}  // namespace

std::string resolved_study(const Study& study) {
  return resolved_draft(study).text();
}

std::string lasting_text(const Study& study) {
  const TomlDraft draft = resolved_draft(study);
  std::set<std::string> left_out;
  for (const TomlDraft::Line& line : draft.lines())
    if (line.value == line.fallback && std::count(kLaterKeys.begin(), kLaterKeys.end(), line.path) > 0)
      left_out.insert(line.path);
  struct Section {  // a table with its heading, or the text before the first table
    std::string text;
    bool has_keys = false, lacks_keys = false;
  };
  std::vector<Section> sections(1);
  std::string table;
  std::istringstream lines(draft.text());
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) {
      table = line.substr(1, line.find(']') - 1) + '.';
      sections.emplace_back().text = line + '\n';
    } else if (left_out.count(table + line.substr(0, line.find(" = "))) > 0) {
      sections.back().lacks_keys = true;
    } else {
      sections.back().text += line + '\n';
      sections.back().has_keys = sections.back().has_keys || !line.empty();
    }
  }
  std::string text;
  for (const Section& section : sections)
    if (section.has_keys || !section.lacks_keys)
      text += section.text;
  return text;
}

std::vector<TomlDraft::Line> resolved_lines(const Study& study) {
  return resolved_draft(study).lines();
}

std::vector<std::string> changed_defaults(const Study& study) {
  std::vector<std::string> changes;
  for (const TomlDraft::Line& line : resolved_lines(study))
    if (!line.fallback.empty() && line.value != line.fallback)
      changes.push_back(fmt::format("{} = {} (default: {})", line.path, line.value, line.fallback));
  return changes;
}

}  // namespace mpm
