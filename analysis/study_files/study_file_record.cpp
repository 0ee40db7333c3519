// [record]

#include <cstdint>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr double kMostOutliers = 0.5;  // above it, the other samples would be the outliers

OptionKeys outliers_keys(RecordOptions& options) {
  return {
      key::number("share", options.outlier_share, {.low = 0, .high = kMostOutliers, .high_included = true},
                  "probability that a sample of a CV is an outlier", "1")
          .required(),
      key::distribution("size", options.outlier_size, NumberRule::positive(),
                        "deviation added to the sample, up or down", "noise standard deviations")};
}

/// Refuses a share that is too large for the length: a gap begins with a probability of at most 1 after each
/// sample that is not missing.
void check_spells(const TomlTable& table, double share, double length) {
  if (const double largest = length / (length + 1.0); share > largest)
    table.refuse("share", fmt::format("{}", share),
                 fmt::format("at most {:.3g} with gaps of {} samples: a sample stands between two gaps",
                             largest, length));
}

OptionKeys bad_keys(RecordOptions& options) {
  return {key::number("share", options.bad_share, NumberRule::inside(0, 1),
                      "long-run share of the samples of each CV that is bad", "1")
              .required()
              .allow("above 0, at most `length` / (`length` + 1)"),
          key::number("length", options.bad_length, NumberRule::at_least(1),
                      "mean length of a spell; lengths are geometrically distributed", "samples"),
          key::check([&options](const TomlTable& table) {
            check_spells(table, options.bad_share, options.bad_length);
          }),
          key::choice("value", options.bad_value,
                      "value during a spell: the last good value, or one value that is far off"),
          key::number("size", options.bad_size, NumberRule::finite(),
                      "distance of an off-scale value from the operating point", "noise standard deviations"),
          key::flag("quality", options.bad_quality,
                    "the record has the quality of each value, so that bad values are left out like gaps and "
                    "filled as `missing.fill` says")};
}

OptionKeys missing_keys(RecordOptions& options) {
  const auto check_share = [&options](const TomlTable& table) {
    check_spells(table, options.missing_share, options.missing_length);
  };
  return {key::number("share", options.missing_share, NumberRule::inside(0, 1),
                      "long-run share of the samples of each CV that is missing", "1")
              .required()
              .allow("above 0, at most `length` / (`length` + 1)"),
          key::number("length", options.missing_length, NumberRule::at_least(1),
                      "mean length of a gap; lengths are geometrically distributed", "samples"),
          key::check(check_share),
          fill_key(options.fill,
                   "what fills a gap: nothing (NaN; methods that need every sample do not apply), the last "
                   "value, or a straight line")};
}

OptionKeys candidates_keys(RecordOptions& options) {
  return {key::whole("count", options.candidates, 1, RecordOptions::kMostCandidates,
                     "number of signals in each loop", "signals")
              .required(),
          key::number(
              "share", options.candidate_share, NumberRule::share(),
              "probability that one of them is the signal v that drives the first disturbance of an "
              "experiment. All others are decoys: they have the form of v and random numbers of their own",
              "1")};
}

/// Refuses sizes in standard deviations of the noise if a CV has no noise: they would all be 0.
void refuse_without_noise(const TomlTable& record, const Study& study) {
  const Eigen::VectorXd& noise = study.simulation.noise_standard_deviation;
  for (const char* key : {"outliers", "quantisation", "bad", "exception", "compression"})
    for (Eigen::Index cv = 0; cv < noise.size(); ++cv)
      if (record.has(key) && noise(cv) == 0.0)
        record.refuse(key,
                      fmt::format("sizes in standard deviations of the noise, which is 0 for {}",
                                  study.plant.cvs[static_cast<std::size_t>(cv)].name),
                      "simulation.noise_standard_deviation > 0 for every CV");
}

/// Reads one number for all CVs, or a table with a number for each variable.
void read_shifts(const TomlTable& record, const std::string& key, Study& study) {
  RecordOptions& options = study.record;
  const NumberRule rule{.low = -RecordOptions::kMostLate,
                        .high = RecordOptions::kMostEarly,
                        .low_included = true,
                        .high_included = true};
  if (!record.require(key, "a number, or a table of variables").is_table()) {
    options.cv_shift.assign(study.plant.cvs.size(), read_number(record, key, rule));
    return;
  }
  std::vector<std::string> names = variable_names(study.plant.cvs);
  for (const auto* variables : {&study.plant.mvs, &study.plant.mds})
    for (const std::string& name : variable_names(*variables))
      names.push_back(name);
  const TomlTable table = record.table(key, names);
  const auto read = [&](const std::vector<PlantModel::Variable>& variables, std::vector<double>& shifts) {
    for (const std::string& name : variable_names(variables))
      shifts.push_back(table.has(name) ? read_number(table, name, rule) : 0.0);
  };
  read(study.plant.cvs, options.cv_shift);
  read(study.plant.mvs, options.mv_shift);
  read(study.plant.mds, options.md_shift);
}

/// Refuses options that need values between the samples, which a foreign simulation does not have.
void refuse_between_samples(const TomlTable& record, const Study& study) {
  if (study.nonlinear && study.nonlinear->model.foreign && study.record.looks_between_samples())
    record.refuse(study.record.sampling == OutputSampling::average ? "sampling" : "shift",
                  "values between the samples of a plant that is a program or an FMU",
                  "\"snapshot\", and shifts of the CVs by whole samples");
}

OptionKeys record_keys(Study& study) {
  RecordOptions& options = study.record;
  return {
      key::choice("sampling", options.sampling,
                  "value of a CV in a row. `\"snapshot\"`: the measurement at the sample. `\"average\"`: the "
                  "mean over the sample time before it, as the average of a historian. The controller gets "
                  "measurements in either case"),
      key::option("shift", "number, or table",
                  "time of the value of a variable after the time of its row: 0.5 is half a sample later, -1 "
                  "is one sample earlier. One number for all CVs, or `{y1 = -0.5, u1 = 1}` with some CVs, "
                  "MVs and MDs. MVs and MDs are held over a sample",
                  "samples")
          .otherwise("0 for each variable")
          .allow(fmt::format("-{} to {}", RecordOptions::kMostLate, RecordOptions::kMostEarly))
          .read([&study](const TomlTable& table, const std::string& key) { read_shifts(table, key, study); }),
      key::check([&study](const TomlTable& table) { refuse_between_samples(table, study); }),
      key::optional_table(
          "outliers", [&options] { return outliers_keys(options); }, "single samples that are far off"),
      key::number("quantisation", options.quantisation, NumberRule::at_least(0), "step between two values",
                  "noise standard deviations")
          .otherwise("0: none"),
      key::optional_table(
          "missing", [&options] { return missing_keys(options); }, "gaps, independent for each CV"),
      key::optional_table(
          "bad", [&options] { return bad_keys(options); },
          "spells of bad values, independent for each CV, with or without their quality"),
      key::number("exception", options.exception, NumberRule::at_least(0),
                  "tolerance of exception reporting: a value is reported if it differs by more than this "
                  "from the last reported value, which the reader holds",
                  "noise standard deviations")
          .otherwise("0: every sample is reported"),
      key::number("compression", options.compression, NumberRule::at_least(0),
                  "tolerance of the swinging-door compression. The reader interpolates between archived "
                  "points, so no sample is off by more than this",
                  "noise standard deviations")
          .otherwise("0: every sample is kept"),
      key::optional_table(
          "candidates", [&options] { return candidates_keys(options); },
          "further signals that are not in the model: some drive a disturbance, others are decoys"),
      key::check([&study](const TomlTable& table) { refuse_without_noise(table, study); })};
}

}  // namespace

OptionKey fill_key(GapFill& fill, std::string meaning) {
  return key::choice("fill", fill, {"none", "hold", "linear"}, std::move(meaning));
}

OptionKey record_key(Study& study) {
  return key::optional_table(
             "record", [&study] { return record_keys(study); },
             "how the historian degrades the record that the methods see")
      .otherwise("none: every sample as it was measured");
}

}  // namespace mpm
