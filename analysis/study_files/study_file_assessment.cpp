// [methods], [assessment], [monitoring], [calibration]

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/method_table.hpp"
#include "analysis/study_files/study_file_parts.hpp"
#include "scenarios/study/assessment_options.hpp"
#include "scenarios/study/window_scan.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxCalibrationLoops = 1'000'000;  // of one kind
constexpr std::int64_t kShortestMonitoringWindow = kShortestWindow + kFewestCorrelatedPairs;

OptionKeys assessment_keys(AssessmentOptions& options) {
  OptionKeys keys{
      key::choice("setpoints", options.setpoints, {"controller", "optimizer"},
                  "setpoint of a CV that is held in a range. `\"controller\"`: none, so methods that need "
                  "setpoints do not apply. `\"optimizer\"`: the steady state that the target optimizer "
                  "computes (2.32), which chapter 2 of the thesis uses to show the consequences"),
      key::choice("model", options.model,
                  "assumption of the methods about the plant without a fault. `\"nominal\"`: it is exactly "
                  "the model. `\"benchmark\"`: it differs from the model as the benchmark shows, and methods "
                  "look for changes since then. `\"automatic\"`: `\"benchmark\"` if the study has `[world]`, "
                  "if the plant is a program or an FMU, or if the benchmark rejects an exact model and "
                  "either the plant is nonlinear or the record has averages or shifts; otherwise "
                  "`\"nominal\"`. `validate` and `run` say which of the two applies"),
      key::number("model_error", options.model_error, NumberRule::positive(),
                  "prior standard deviation of the relative error of the gain and the time constant of each "
                  "channel, and of the error of its dead time as a fraction of the dead time or of a sample"),
      key::number(
          "bias", options.bias, NumberRule::at_least(0),
          "prior standard deviation of a constant error of each CV, in standard deviations of its noise"),
      key::option("washout", "number",
                  "time constant of the high-pass filter through which methods see a CV that integrates and "
                  "its model, since a simulation of a level drifts without end",
                  "time")
          .otherwise("the prediction horizon")
          .allow("> 0")
          .read([&options](const TomlTable& table, const std::string& key) {
            options.washout = read_number(table, key, NumberRule::positive());
          })};
  for (const MethodOptionTable& table : method_table(options).option_tables())
    keys.push_back(key::table(
        table.name, [&options, of_method = table.keys] { return of_method(options); }, table.meaning));
  return keys;
}

OptionKeys methods_keys(std::vector<std::string>& names) {
  return {
      key::texts("names", names, "names of methods of assessment, or \"all\" alone",
                 "methods that assess every loop of the study (`mpmbench compare --help` lists them), or "
                 "`[\"all\"]`. `botelho` is the chain of the thesis. `run --methods A,B` overrides the list")
          .allow("names of methods, each once")};
}

/// A table that turns on a feature that only studies of random experiments have.
template <class Options>
OptionKey random_part(const char* name, Study& study, std::optional<Options> Study::*part,
                      OptionKeys (*keys)(Options&, const Study&), const char* meaning) {
  const auto below = [keys] {
    const Study no_study;
    Options options;
    return keys(options, no_study);
  };
  const auto read = [&study, part, keys](const TomlTable& document, const std::string& key) {
    Options options;
    const OptionKeys of_part = keys(options, study);
    const TomlTable table = document.table(key, key_names(of_part));
    if (study.names_scenarios())
      table.refuse("", key + " of a study of named scenarios", "only in a study of random experiments");
    read_keys(table, of_part);
    study.*part = options;
  };
  return key::option(name, "table", meaning).with("", below).read(read);
}

OptionKeys monitoring_keys(MonitoringOptions& options, const Study& study) {
  const std::int64_t samples = study.simulation.samples;
  options.window = static_cast<int>(std::min<std::int64_t>(options.window, samples));
  options.stride = static_cast<int>(std::min<std::int64_t>(options.stride, samples));
  return {
      key::whole(
          "window", options.window, std::min(kShortestMonitoringWindow, samples), samples,
          "number of samples that a verdict covers. Methods that filter or simulate the loop start at the "
          "beginning of the record and judge these samples. A longer window finds smaller faults, but later")
          .otherwise("200, or the whole record where it is shorter")
          .allow("24 to `simulation.samples`"),
      key::whole("stride", options.stride, 1, samples, "number of samples from one verdict to the next")
          .allow("1 to `simulation.samples`")};
}

OptionKeys calibration_keys(CalibrationOptions& options, const Study& study) {
  // With the seed of the study, the calibration loops would be the very loops on which the thresholds are
  // tried.
  const auto read_seed = [&](const TomlTable& table, const std::string& key) {
    options.seed =
        static_cast<std::uint64_t>(read_whole(table, key, 0, std::numeric_limits<std::int64_t>::max()));
    if (*options.seed == study.seed)
      table.refuse(key, fmt::format("{}, the seed of the study", *options.seed), "another one");
  };
  return {key::number("false_alarms", options.false_alarms, NumberRule::inside(0, 1),
                      "largest share of healthy loops that the threshold of the rate "
                      "`false_alarm_calibrated` may flag; the other thresholds are at 1 % and 5 %"),
          key::whole("healthy", options.healthy, 1, kMaxCalibrationLoops,
                     "number of loops without a fault. A threshold at 1 % needs 99, one at 5 % needs 19; "
                     "with 200 the rate at 5 % lies within 2.4 and 8.4 %"),
          key::whole("ud", options.ud, 0, kMaxCalibrationLoops,
                     "number of loops with an unmeasured disturbance alone, for the thresholds of a monitor "
                     "of the model, which should not flag them"),
          key::option("worlds", "whole number",
                      "number of worlds in which these loops take place, each with a benchmark of its own. "
                      "Scores of loops of one world are alike, so many worlds with few loops each give a "
                      "better threshold than few worlds with many loops")
              .otherwise("`world.count`")
              .allow("1 to 1000000; in a study with `[world]`")
              .read([&options](const TomlTable& table, const std::string& key) {
                options.worlds = static_cast<int>(read_whole(table, key, 1, kMaxCalibrationLoops));
              }),
          key::option("seed", "whole number", "seed of these loops")
              .otherwise("the seed of the study with the bits of 0x63616c6962726174 (\"calibrat\") flipped")
              .allow("neither the seed of the study nor that of `run --seed`")
              .read(read_seed)};
}

}  // namespace

OptionKeys method_keys(Study& study) {
  return {
      key::table(
          "methods", [&study] { return methods_keys(study.methods); }, "the methods that assess the loops"),
      key::table(
          "assessment", [&study] { return assessment_keys(study.assessment); },
          "the open choices of the methods of the literature"),
      random_part("monitoring", study, &Study::monitoring, monitoring_keys,
                  "methods on a window that moves over the record: delay of detection, false alarms per day")
          .otherwise("none: methods see whole records only"),
      random_part("calibration", study, &Study::calibration, calibration_keys,
                  "loops of another seed on which the thresholds of the methods are calibrated")
          .otherwise("none: no calibrated thresholds")};
}

}  // namespace mpm
