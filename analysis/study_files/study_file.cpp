#include "analysis/study_files/study_file.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "analysis/study_files/study_file_keys.hpp"
#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/study_programs.hpp"
#include "base/error.hpp"
#include "scenarios/study/window_scan.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {
namespace {

OptionKeys heading_keys(Study& study) {
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  return {key::name("name", study.name,
                    "short name, used in file names; a shipped study has the name of its file"),
          key::text("title", study.title, "title in one line").required(),
          key::whole("seed", study.seed, 0, kLargest, "master seed: the same seed gives the same experiments")
              .required()};
}

/// The keys of the whole study file. `folder` is that of the file.
OptionKeys study_keys(Study& study, const std::filesystem::path& folder) {
  OptionKeys keys{key::table(
                      "study", [&study] { return heading_keys(study); }, "name of the study")
                      .required(),
                  plant_key(study, folder),
                  controller_key(study),
                  simulation_key(study),
                  record_key(study),
                  experiments_key(study),
                  world_key(study),
                  scenarios_key(study)};
  const auto add = [&keys](const OptionKeys& more) { keys.insert(keys.end(), more.begin(), more.end()); };
  add(fault_keys(study));
  add(analysis_keys(study));
  add(method_keys(study));
  add({aggregate_key(study), data_key(study), reference_key(study)});
  return keys;
}

[[noreturn]] void refuse_in(const TomlTable& document, const char* table, const char* key,
                            const std::string& found, const std::string& allowed) {
  document.table(table, key_names(study_file_keys(table))).refuse(key, found, allowed);
}

/// Refuses a CV whose first analysis arrives after the end of the record: it would never be measured.
void refuse_silent_analysers(const TomlTable& document, const Study& study) {
  const std::vector<AnalyserTiming>& timings = study.controller.analysers;
  for (std::size_t cv = 0; cv < timings.size(); ++cv)
    if (const AnalyserTiming& timing = timings[cv]; timing.taken(study.simulation.samples - 1) < 0)
      throw InputError(
          fmt::format("{}.cv.{}.analyser_delay", document.where("controller"), study.plant.cvs[cv].name),
          fmt::format("{} samples", timing.delay),
          fmt::format("fewer than the {} of the record (simulation.samples), which ends before the first "
                      "analysis is there",
                      study.simulation.samples));
}

/// Checks the moving windows of (6.13) and (6.14), in samples, against the horizon and the length of the
/// record.
void refuse_unusable_windows(const TomlTable& document, const Study& study) {
  const WindowScan scan = window_scan(study);
  if (scan.shortest < kShortestWindow) {
    refuse_in(document, "controller", "prediction_horizon",
              fmt::format("{} (the shortest moving window has {} samples)",
                          study.controller.prediction_horizon, scan.shortest),
              fmt::format("windows of at least {} samples", kShortestWindow));
  }
  if (scan.longest < scan.shortest) {
    refuse_in(document, "diagnosis", "windows",
              fmt::format("[{}, {}]", study.diagnosis.shortest_window, study.diagnosis.longest_window),
              fmt::format("a whole number of samples between them, at a prediction horizon of {} samples",
                          study.controller.prediction_horizon));
  }
  if (study.simulation.samples < scan.longest + kFewestCorrelatedPairs) {
    refuse_in(document, "simulation", "samples", fmt::format("{}", study.simulation.samples),
              fmt::format("at least {}: the longest moving window has {} samples",
                          scan.longest + kFewestCorrelatedPairs, scan.longest));
  }
}

}  // namespace

Study read_study(std::string_view text, const std::string& file_name,
                 std::shared_ptr<const MethodTable> methods, TomlDraft* draft) {
  const toml::table toml = parse_toml(text, file_name);
  Study study;
  study.assessment.table = std::move(methods);
  const OptionKeys keys = study_keys(study, std::filesystem::path(file_name).parent_path());
  const TomlTable document(toml, file_name, key_names(keys), draft);
  read_keys(document, keys);
  refuse_silent_analysers(document, study);
  refuse_unusable_windows(document, study);
  study.source = text;
  return study;
}

const std::vector<KeyTable>& study_file_tables() {
  static const std::vector<KeyTable> tables = [] {
    Study study;
    std::vector<KeyTable> made = key_tables("", study_keys(study, {}));
    made.push_back({"DISTRIBUTION", key::distribution_keys()});
    return made;
  }();
  return tables;
}

const OptionKeys& study_file_keys(std::string_view table) {
  const std::vector<KeyTable>& tables = study_file_tables();
  const auto found = std::find_if(tables.begin(), tables.end(),
                                  [table](const KeyTable& entry) { return entry.name == table; });
  assert(found != tables.end());
  return found->keys;
}

Study parse_study(std::string_view text, const std::string& file_name,
                  std::shared_ptr<const MethodTable> methods) {
  return read_study(text, file_name, std::move(methods), nullptr);
}

namespace {

/// Loads the parts that parse_study() leaves until the first loop. The file must be the user's own.
Study with_outside_parts(Study study) {
  trust_programs_of(study);
  if (study.nonlinear && study.nonlinear->model.foreign)
    study.nonlinear->model.foreign->load();
  if (study.controller_program)
    study.controller_program->runs_on_model();
  return study;
}

constexpr const char* kStudyFile = "a study file";

}  // namespace

Study load_study(const std::filesystem::path& path) {
  return with_outside_parts(parse_study(read_toml_file(path, kStudyFile), path.string()));
}

Study load_study(std::istream& stream, const std::string& name, std::shared_ptr<const MethodTable> methods) {
  return with_outside_parts(
      parse_study(read_toml_stream(stream, name, kStudyFile), name, std::move(methods)));
}

}  // namespace mpm
