#include "scenarios/files/study_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/files/study_programs.hpp"
#include "scenarios/study/window_scan.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

void read_heading(const TomlTable& document, Study& study) {
  const TomlTable table = document.table("study", study_file_keys("study"));
  study.name = read_name(table, "name");
  study.title = read_text(table, "title");
  study.seed =
      static_cast<std::uint64_t>(read_whole(table, "seed", 0, std::numeric_limits<std::int64_t>::max()));
}

/// The moving windows of (6.13) and (6.14), in samples, against the horizon and the length of the record.
void refuse_unusable_windows(const TomlTable& document, const Study& study) {
  const WindowScan scan = window_scan(study);
  if (scan.shortest < kShortestWindow) {
    const TomlTable controller = document.table("controller", study_file_keys("controller"));
    controller.refuse("prediction_horizon",
                      fmt::format("{} (the shortest moving window has {} samples)",
                                  study.controller.prediction_horizon, scan.shortest),
                      fmt::format("windows of at least {} samples", kShortestWindow));
  }
  if (scan.longest < scan.shortest) {
    const TomlTable diagnosis = document.table("diagnosis", study_file_keys("diagnosis"));
    diagnosis.refuse(
        "windows", fmt::format("[{}, {}]", study.diagnosis.shortest_window, study.diagnosis.longest_window),
        fmt::format("a whole number of samples between them, at a prediction horizon of {} samples",
                    study.controller.prediction_horizon));
  }
  if (study.simulation.samples < scan.longest + kFewestCorrelatedPairs) {
    const TomlTable simulation = document.table("simulation", study_file_keys("simulation"));
    simulation.refuse("samples", fmt::format("{}", study.simulation.samples),
                      fmt::format("at least {}: the longest moving window has {} samples",
                                  scan.longest + kFewestCorrelatedPairs, scan.longest));
  }
}

}  // namespace

Study read_study(std::string_view text, const std::string& file_name, TomlDraft* draft) {
  const toml::table toml = parse_toml(text, file_name);
  const TomlTable document(toml, file_name, study_file_keys(""), draft);
  Study study;
  read_heading(document, study);
  study.plant = read_plant(document);
  study.nonlinear =
      read_nonlinear_simulation(document, study.plant, std::filesystem::path(file_name).parent_path());
  study.controller = read_controller(document, study.plant);
  study.controller_program = read_controller_program(document);
  study.simulation = read_simulation(document, study.plant, study.controller);
  study.record = read_record(document, study);
  study.scenarios = read_scenarios(document, study);
  study.experiments = read_experiments(document);
  study.disturbance = read_disturbance(document);
  if (!study.names_scenarios()) {
    study.mismatch = read_mismatch(document, study);
    study.tuning = read_tuning(document, study);
    study.other = read_other(document, study);
    study.onset = read_onset(document, study);
  }
  study.sensitivity = read_sensitivity(document, study.plant, study.controller);
  study.s0_perturbation = read_s0_perturbation(document, study.plant, study.controller);
  study.diagnosis = read_diagnosis(document);
  study.methods = read_methods(document);
  study.assessment = read_assessment(document);
  study.monitoring = read_monitoring(document, study);
  study.calibration = read_calibration(document, study);
  study.aggregate = read_aggregate(document);
  study.data = read_data(document, study);
  study.reported = read_reported(document);
  refuse_unusable_windows(document, study);
  study.source = text;
  return study;
}

Study parse_study(std::string_view text, const std::string& file_name) {
  return read_study(text, file_name, nullptr);
}

namespace {

/// With what parse_study() leaves for the first loop. The file is the user's own.
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

Study load_study(std::istream& stream, const std::string& name) {
  return with_outside_parts(parse_study(read_toml_stream(stream, name, kStudyFile), name));
}

}  // namespace mpm
