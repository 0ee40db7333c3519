#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_template.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/commands/sketch_words.hpp"
#include "bench/commands/step_model.hpp"
#include "bench/console/output.hpp"
#include "bench/files/new_file.hpp"
#include "results/records/data_sketch.hpp"
#include "results/records/record_file.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

struct InitArguments {
  std::string output, data, step_response;
  std::optional<double> step_interval;
  SketchWords words;
};

std::string asked(const std::string& question, const std::string& fallback) {
  print_note(fmt::format("{}{}: ", question, fallback.empty() ? "" : fmt::format(" [{}]", fallback)));
  std::string answer;
  if (!std::getline(std::cin, answer))
    throw std::runtime_error("no more answers: nothing was written");
  answer.erase(0, answer.find_first_not_of(" \t"));
  answer.erase(answer.find_last_not_of(" \t") + 1);
  return answer.empty() ? fallback : answer;
}

/// Asks on a terminal for what the options have left open.
void ask(SketchWords& words) {
  print_note(
      "A study of your plant, in deviations from the operating point. An empty answer takes what stands in "
      "brackets.\n");
  words.cvs = asked("Controlled variables: names, or how many", "1");
  words.mvs = asked("Manipulated variables", "1");
  words.mds = asked("Measured disturbances", "0");
  words.time_unit = asked("Unit of time", words.time_unit);
  const StudySketch named = sketch_of(words, "plant");
  for (const PlantModel::Variable& cv : named.plant.cvs) {
    for (const auto* list : {&named.plant.mvs, &named.plant.mds})
      for (const PlantModel::Variable& input : *list)
        if (const std::string answer =
                asked(fmt::format("From {} to {}: NUMERATOR / DENOMINATOR @ DEAD_TIME, such as 2 / 10 1 @ 3; "
                                  "empty: no channel",
                                  input.name, cv.name),
                      "");
            !answer.empty())
          words.channels.push_back(fmt::format("{},{}={}", cv.name, input.name, answer));
    const std::string range =
        asked(fmt::format("Range of {}, LOW:HIGH; empty: it has a setpoint", cv.name), "");
    if (!range.empty())
      words.ranges.push_back(fmt::format("{}={}", cv.name, range));
    else
      words.setpoints.push_back(fmt::format(
          "{}={}", cv.name, asked(fmt::format("By how much the setpoint of {} moves", cv.name), "1")));
  }
  for (const PlantModel::Variable& mv : named.plant.mvs)
    if (const std::string limits = asked(fmt::format("Limits of {}, LOW:HIGH; empty: none", mv.name), "");
        !limits.empty())
      words.limits.push_back(fmt::format("{}={}", mv.name, limits));
}

/// Takes the names of variables from the model where the words have none.
StepModel named_by(StepModel model, SketchWords& words) {
  SketchWords measured;
  measured.mds = words.mds;
  const std::vector<std::string> mds = variable_names(sketch_of(measured, "").plant.mds);
  if (words.cvs.empty())
    words.cvs = fmt::format("{}", fmt::join(model.cvs(), ","));
  if (words.mvs.empty())
    words.mvs = fmt::format("{}", fmt::join(model.inputs_but(mds), ","));
  return model;
}

void require_model(const SketchWords& words) {
  if (words.cvs.empty() || words.mvs.empty())
    throw InputError(words.cvs.empty() ? "--cvs" : "--mvs", "nothing",
                     "names separated by commas, or how many; without any option, questions on a terminal");
  if (words.channels.empty() && words.gains.empty())
    throw InputError("--gains", "no model",
                     "--gains with --time-constants, --channel for each channel, or --step-response");
}

/// Fills in from a file of records what the options leave open. Returns in words what it has filled in.
std::vector<std::string> take_from_data(const DataSketch& data, StudySketch& sketch,
                                        const std::optional<StepModel>& steps, const SketchWords& words) {
  const auto rounded = [](double value, int digits) {
    return std::stod(fmt::format("{:.{}g}", value, digits));
  };
  constexpr double kMove = 3.0;  // move of a setpoint, in standard deviations of the record
  bool noise = false, moves = false;
  sketch.noise.assign(sketch.plant.cvs.size(), 0.0);
  for (std::size_t i = 0; i < sketch.plant.cvs.size(); ++i) {
    const std::string& name = sketch.plant.cvs[i].name;
    if (const auto found = data.noise.find(name); found != data.noise.end() && found->second > 0) {
      sketch.noise[i] = found->second;
      noise = true;
    }
    const bool sized = std::any_of(words.setpoints.begin(), words.setpoints.end(),
                                   [&](const std::string& text) { return text.starts_with(name + "="); });
    if (const auto spread = data.spread.find(name);
        !sized && spread != data.spread.end() && spread->second > 0) {
      sketch.size(static_cast<Eigen::Index>(i)) = rounded(kMove * spread->second, 2);
      moves = moves || !sketch.ranges[i];
    }
  }
  constexpr double kOftener = 0.2;  // of the guessed time; faster rows are the historian's, not the MPC's
  const double guessed = parse_study(study_template(sketch), "study").controller.sample_time;
  const bool slow = steps ? data.step > guessed : data.step >= kOftener * guessed;
  const bool sampled = !words.sample_time && slow;
  if (sampled)
    sketch.sample_time = rounded(data.step, 6);
  std::vector<std::string> taken;
  for (const auto& [is, what] :
       {std::pair(noise, "the noise in [simulation]"), std::pair(moves, "how far setpoints move"),
        std::pair(sampled, "the sample time in [controller], one row of the file")})
    if (is)
      taken.emplace_back(what);
  return taken;
}

/// The comment before [data] on what else is guessed from the file.
std::string words_on_guesses(const DataSketch& data, const std::vector<std::string>& taken) {
  std::string text =
      taken.empty() ? "\n" : fmt::format("\n# From {} as well: {}.\n", data.file, fmt::join(taken, ", and "));
  for (const auto& [variable, period] : data.periods) {
    const bool is_cv = data.noise.contains(variable);
    text += fmt::format(
        "# To do: {0} has a new value every {1} rows, as the {2} of an analyser: if it is one, write "
        "analyser_period, {1} rows in samples, and analyser_delay into [controller.{3}.{0}].{4}\n",
        variable, period, is_cv ? "CV" : "MD", is_cv ? "cv" : "md",
        is_cv ? " Its noise is that of the new values." : "");
  }
  for (const auto& [mv, rests] : data.rests)
    text += fmt::format("# To do: the cost of {}, if it has one: {}.\n", mv, rests);
  return text + "\n";
}

/// Writes [data] alone, because the user says nothing about the plant.
ExitCode init_data(const InitArguments& arguments) {
  PlantModel plant;
  plant.time_unit = arguments.words.time_unit;
  const std::string text = data_sketch(plant, load_record_columns(arguments.data, DataOptions())).table;
  if (arguments.output == "-")
    print_result(text);
  else
    write_new(arguments.output, text);
  print_note("mpmbench: no --cvs and --mvs: only [data], with a list of the columns\n");
  return ExitCode::done;
}

ExitCode init(InitArguments arguments) {
  const bool to_stdout = arguments.output == "-";
  if (!to_stdout)
    require_new(arguments.output);
  std::optional<StepModel> steps;
  if (!arguments.step_response.empty())
    steps = named_by(read_step_model(arguments.step_response, arguments.step_interval), arguments.words);
  const bool nothing_said = arguments.words.cvs.empty() && arguments.words.mvs.empty();
  if (nothing_said && ::isatty(STDIN_FILENO) == 1)
    ask(arguments.words);
  else if (nothing_said && !arguments.data.empty())
    return init_data(arguments);
  if (!steps)
    require_model(arguments.words);
  StudySketch sketch = sketch_of(arguments.words, to_stdout ? "my-plant" : name_of_file(arguments.output));
  if (steps) {
    steps->put_into(sketch.plant);
    sketch.sample_time = arguments.words.sample_time.value_or(steps->interval);
  }
  std::string of_data;
  if (!arguments.data.empty()) {
    const DataSketch data = data_sketch(sketch.plant, load_record_columns(arguments.data, DataOptions()));
    const std::vector<std::string> taken = take_from_data(data, sketch, steps, arguments.words);
    of_data = words_on_guesses(data, taken) + data.table;
  }
  const std::string text = study_template(sketch) + of_data;
  const Study study = parse_study(text, arguments.output);
  const BasisCase basis = run_basis_case(study, qp_solver_factory("auto"));
  if (to_stdout)
    print_result(text);
  else
    write_new(arguments.output, text);
  if (steps)
    print_note(steps->report());
  if (!basis.healthy)
    print_note(fmt::format(
        "mpmbench: warning: the basis case fails its self-check: {}\nThe first guesses of weights "
        "and horizons do not suit this plant: change them, and see `mpmbench validate`.\n",
        basis.explanation));
  if (!to_stdout)
    print_result(
        fmt::format("{0}: CVs {1}, MVs {2}, MDs {3}, experiments {4}\nLook at it, then:\n"
                    "  mpmbench validate {0}\n  mpmbench run {0} -o {5}.h5\n",
                    arguments.output, study.cv_count(), study.mv_count(), study.md_count(),
                    study.experiment_count(), study.name));
  return ExitCode::done;
}

}  // namespace

void add_init(CommandSet& commands) {
  const auto options = std::make_shared<InitArguments>();
  CLI::App& app = commands.add("init", "Write a study of your own plant, with a comment on every key",
                               [options] { return init(*options); });
  add_path(app, "STUDY", options->output, "Study file to write; it must not exist yet; - for stdout")
      ->required();
  add_path(
      app, "--data", options->data,
      "File of records of the plant: its columns, period, sample time, operating point and noise as first "
      "guesses, in [data]");
  app.add_option("--cvs", options->words.cvs, "Controlled variables: names separated by commas, or how many");
  app.add_option("--mvs", options->words.mvs,
                 "Manipulated variables: names separated by commas, or how many");
  app.add_option("--mds", options->words.mds,
                 "Measured disturbances: names separated by commas, or how many");
  app.add_option("--unit", options->words.units, "Unit of a variable, NAME=UNIT")->allow_extra_args(false);
  app.add_option("--time-unit", options->words.time_unit, "Unit of time")->capture_default_str();
  app.add_option("--gains", options->words.gains,
                 "Gains, one row for each CV, one column for each MV and MD: '1 2; 3 4'; 0 for no channel");
  app.add_option("--time-constants", options->words.time_constants, "Time constants, in the form of --gains");
  app.add_option("--dead-times", options->words.dead_times,
                 "Dead times, in the form of --gains (default: 0)");
  app.add_option("--channel", options->words.channels,
                 "Transfer function of a channel, CV,INPUT=NUMERATOR/DENOMINATOR[@DEAD_TIME], coefficients "
                 "in descending powers of s: y1,u1='4.05 / 50 1 @ 27'")
      ->allow_extra_args(false);
  add_path(
      app, "--step-response", options->step_response,
      "File of the coefficients of step responses, a column CV/INPUT for each channel, as dynamic matrix "
      "control has its model; --cvs and --mvs are then those of the file");
  app.add_option("--step-interval", options->step_interval,
                 "Time between two coefficients (default: from the column `time` of the file)")
      ->needs("--step-response")
      ->check(positive_number());
  app.add_option("--sample-time", options->words.sample_time,
                 "Sample time (default: the time between two coefficients, else from the time constants)")
      ->check(positive_number());
  app.add_option("--range", options->words.ranges, "Range in which the controller holds a CV, NAME=LOW:HIGH")
      ->allow_extra_args(false);
  app.add_option("--setpoint", options->words.setpoints,
                 "How far the setpoint of a CV without a range moves, NAME=SIZE (default: 1)")
      ->allow_extra_args(false);
  app.add_option("--limits", options->words.limits, "Hard limits of an MV, NAME=LOW:HIGH")
      ->allow_extra_args(false);
}

}  // namespace mpm
