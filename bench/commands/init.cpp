#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "analysis/basis/basis_case.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/study_file.hpp"
#include "scenarios/study_template.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {
namespace {

/// As they are typed, in options or as answers.
struct InitArguments {
  std::string output;
  std::string cvs, mvs, mds;  ///< names, or how many
  std::string time_unit = "min";
  std::vector<std::string> units;                 ///< NAME=UNIT
  std::vector<std::string> channels;              ///< CV,INPUT=NUMERATOR/DENOMINATOR[@DEAD_TIME]
  std::string gains, time_constants, dead_times;  ///< matrices
  std::optional<double> sample_time;
  std::vector<std::string> ranges, setpoints, limits;
};

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos
             ? std::string()
             : std::string(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
}

/// The pieces between any of these characters, without the blanks around them; those that are empty are left
/// out.
std::vector<std::string> pieces(std::string_view text, std::string_view between) {
  std::vector<std::string> found;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(between), text.size());
    if (std::string piece = trimmed(text.substr(0, end)); !piece.empty())
      found.push_back(std::move(piece));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return found;
}

double number_of(const std::string& word, const std::string& place) {
  double number = 0.0;
  const char* const end = word.data() + word.size();
  const auto read = std::from_chars(word.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end || std::isnan(number))
    throw InputError(place, fmt::format("'{}'", word), "a number");
  return number;
}

Eigen::VectorXd numbers_of(std::string_view text, const std::string& place) {
  const std::vector<std::string> words = pieces(text, " ,");
  if (words.empty())
    throw InputError(place, fmt::format("'{}'", text), "one number or more");
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(words.size()));
  for (Eigen::Index i = 0; i < numbers.size(); ++i)
    numbers(i) = number_of(words[static_cast<std::size_t>(i)], place);
  return numbers;
}

/// "y1, y2", or "2" for y1 and y2.
std::vector<PlantModel::Variable> variables(const std::string& text, char letter, const std::string& option) {
  std::vector<std::string> names = pieces(text, " ,");
  constexpr int kMost = 200;
  if (names.size() == 1 && names[0].find_first_not_of("0123456789") == std::string::npos) {
    const double count = number_of(names[0], option);
    if (count > kMost)
      throw InputError(option, names[0], fmt::format("at most {}", kMost));
    names.clear();
    for (int i = 1; i <= static_cast<int>(count); ++i)
      names.push_back(fmt::format("{}{}", letter, i));
  }
  std::vector<PlantModel::Variable> list;
  for (const std::string& name : names)
    list.push_back({name, "1", ""});
  return list;
}

/// The place of a name in lists of variables, one behind the other.
std::size_t place_of(const std::string& name,
                     const std::vector<const std::vector<PlantModel::Variable>*>& lists,
                     const std::string& option) {
  std::size_t place = 0;
  std::vector<std::string> names;
  for (const auto* list : lists)
    for (const PlantModel::Variable& variable : *list) {
      if (variable.name == name)
        return place;
      names.push_back(variable.name);
      ++place;
    }
  throw InputError(option, fmt::format("'{}'", name), fmt::format("{}", fmt::join(names, ", ")));
}

/// "NAME=VALUE"
std::pair<std::string, std::string> assignment(const std::string& text, const std::string& option) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw InputError(option, fmt::format("'{}'", text), "NAME=VALUE");
  return {trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1))};
}

/// "LOW:HIGH"
std::pair<double, double> interval_of(const std::string& text, const std::string& option) {
  const std::vector<std::string> ends = pieces(text, ":");
  if (ends.size() != 2)
    throw InputError(option, fmt::format("'{}'", text), "LOW:HIGH");
  return {number_of(ends[0], option), number_of(ends[1], option)};
}

/// "4.05 / 50 1 @ 27": 4.05 e^(-27 s) / (50 s + 1).
TransferFunction transfer_function_of(const std::string& text, const std::string& place) {
  const std::size_t at = text.find('@'), slash = text.find('/');
  if (slash == std::string::npos || (at != std::string::npos && at < slash))
    throw InputError(place, fmt::format("'{}'", text),
                     "NUMERATOR / DENOMINATOR [@ DEAD_TIME], coefficients in descending powers of s, such as "
                     "4.05 / 50 1 @ 27");
  const double dead_time = at == std::string::npos ? 0.0 : number_of(trimmed(text.substr(at + 1)), place);
  const std::size_t end = std::min(at, text.size());
  try {
    return TransferFunction(numbers_of(text.substr(0, slash), place),
                            numbers_of(text.substr(slash + 1, end - slash - 1), place), dead_time);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
}

/// "1 2; 3 4": a row a CV, a column an MV or MD.
Eigen::MatrixXd matrix_of(const std::string& text, const TransferMatrix& G, const std::string& option) {
  const std::vector<std::string> rows = pieces(text, ";");
  Eigen::MatrixXd matrix(G.rows(), G.cols());
  bool fits = static_cast<Eigen::Index>(rows.size()) == G.rows();
  for (Eigen::Index i = 0; fits && i < G.rows(); ++i) {
    const Eigen::VectorXd row = numbers_of(rows[static_cast<std::size_t>(i)], option);
    fits = row.size() == G.cols();
    if (fits)
      matrix.row(i) = row.transpose();
  }
  if (!fits)
    throw InputError(
        option, fmt::format("'{}'", text),
        fmt::format("{} rows of {} numbers, with ; between the rows: a row a CV, a column an MV or MD",
                    G.rows(), G.cols()));
  return matrix;
}

void read_matrices(const InitArguments& arguments, TransferMatrix& G) {
  const Eigen::MatrixXd gains = matrix_of(arguments.gains, G, "--gains");
  const Eigen::MatrixXd times = matrix_of(arguments.time_constants, G, "--time-constants");
  const Eigen::MatrixXd dead = arguments.dead_times.empty()
                                   ? Eigen::MatrixXd::Zero(G.rows(), G.cols()).eval()
                                   : matrix_of(arguments.dead_times, G, "--dead-times");
  for (Eigen::Index i = 0; i < G.rows(); ++i)
    for (Eigen::Index j = 0; j < G.cols(); ++j)
      if (gains(i, j) != 0)
        G(i, j) = TransferFunction::first_order(gains(i, j), times(i, j), dead(i, j));
}

void read_channels(const InitArguments& arguments, PlantModel& plant) {
  for (const std::string& text : arguments.channels) {
    const auto [channel, function] = assignment(text, "--channel");
    const std::vector<std::string> ends = pieces(channel, " ,");
    if (ends.size() != 2)
      throw InputError("--channel", fmt::format("'{}'", text), "CV,INPUT=NUMERATOR/DENOMINATOR[@DEAD_TIME]");
    const std::size_t cv = place_of(ends[0], {&plant.cvs}, "--channel");
    const std::size_t input = place_of(ends[1], {&plant.mvs, &plant.mds}, "--channel");
    plant.G(static_cast<Eigen::Index>(cv), static_cast<Eigen::Index>(input)) =
        transfer_function_of(function, fmt::format("--channel {}", channel));
  }
}

StudySketch sketch_of(const InitArguments& arguments, const std::string& name) {
  StudySketch sketch;
  PlantModel& plant = sketch.plant;
  plant.name = name;
  plant.title = name;
  plant.time_unit = arguments.time_unit;
  plant.cvs = variables(arguments.cvs, 'y', "--cvs");
  plant.mvs = variables(arguments.mvs, 'u', "--mvs");
  plant.mds = variables(arguments.mds, 'd', "--mds");
  const auto cv_count = static_cast<Eigen::Index>(plant.cvs.size());
  plant.G = TransferMatrix(cv_count, static_cast<Eigen::Index>(plant.mvs.size() + plant.mds.size()));
  for (const std::string& text : arguments.units) {
    const auto [variable, unit] = assignment(text, "--unit");
    std::size_t place = place_of(variable, {&plant.cvs, &plant.mvs, &plant.mds}, "--unit");
    for (auto* list : {&plant.cvs, &plant.mvs, &plant.mds}) {
      if (place < list->size()) {
        (*list)[place].unit = unit;
        break;
      }
      place -= list->size();
    }
  }
  if (!arguments.gains.empty() || !arguments.time_constants.empty() || !arguments.dead_times.empty())
    read_matrices(arguments, plant.G);
  read_channels(arguments, plant);
  sketch.sample_time = arguments.sample_time;
  sketch.ranges.resize(plant.cvs.size());
  for (const std::string& text : arguments.ranges) {
    const auto [cv, range] = assignment(text, "--range");
    sketch.ranges[place_of(cv, {&plant.cvs}, "--range")] = interval_of(range, "--range");
  }
  sketch.size = Eigen::VectorXd::Ones(cv_count);
  for (const std::string& text : arguments.setpoints) {
    const auto [cv, size] = assignment(text, "--setpoint");
    sketch.size(static_cast<Eigen::Index>(place_of(cv, {&plant.cvs}, "--setpoint"))) =
        number_of(size, "--setpoint");
  }
  sketch.mv_hard = Limits::none(static_cast<Eigen::Index>(plant.mvs.size()));
  for (const std::string& text : arguments.limits) {
    const auto [mv, limits] = assignment(text, "--limits");
    const auto place = static_cast<Eigen::Index>(place_of(mv, {&plant.mvs}, "--limits"));
    std::tie(sketch.mv_hard.lower(place), sketch.mv_hard.upper(place)) = interval_of(limits, "--limits");
  }
  return sketch;
}

std::string asked(const std::string& question, const std::string& fallback) {
  print_note(fmt::format("{}{}: ", question, fallback.empty() ? "" : fmt::format(" [{}]", fallback)));
  std::string answer;
  if (!std::getline(std::cin, answer))
    throw std::runtime_error("no more answers: nothing was written");
  answer = trimmed(answer);
  return answer.empty() ? fallback : answer;
}

/// On a terminal, what the options have left open.
void ask(InitArguments& arguments) {
  print_note(
      "A study of your plant, in deviations from the operating point. An empty answer takes what stands in "
      "brackets.\n");
  arguments.cvs = asked("Controlled variables: names, or how many", "1");
  arguments.mvs = asked("Manipulated variables", "1");
  arguments.mds = asked("Measured disturbances", "0");
  arguments.time_unit = asked("Unit of time", arguments.time_unit);
  const StudySketch named = sketch_of(arguments, "plant");
  for (const PlantModel::Variable& cv : named.plant.cvs) {
    for (const auto* list : {&named.plant.mvs, &named.plant.mds})
      for (const PlantModel::Variable& input : *list)
        if (const std::string answer =
                asked(fmt::format("From {} to {}: NUMERATOR / DENOMINATOR @ DEAD_TIME, such as 2 / 10 1 @ 3; "
                                  "empty: no channel",
                                  input.name, cv.name),
                      "");
            !answer.empty())
          arguments.channels.push_back(fmt::format("{},{}={}", cv.name, input.name, answer));
    const std::string range =
        asked(fmt::format("Range of {}, LOW:HIGH; empty: it has a setpoint", cv.name), "");
    if (!range.empty())
      arguments.ranges.push_back(fmt::format("{}={}", cv.name, range));
    else
      arguments.setpoints.push_back(fmt::format(
          "{}={}", cv.name, asked(fmt::format("By how much the setpoint of {} moves", cv.name), "1")));
  }
  for (const PlantModel::Variable& mv : named.plant.mvs)
    if (const std::string limits = asked(fmt::format("Limits of {}, LOW:HIGH; empty: none", mv.name), "");
        !limits.empty())
      arguments.limits.push_back(fmt::format("{}={}", mv.name, limits));
}

void require_model(const InitArguments& arguments) {
  if (arguments.cvs.empty() || arguments.mvs.empty())
    throw InputError(arguments.cvs.empty() ? "--cvs" : "--mvs", "nothing",
                     "names separated by commas, or how many; without any option, questions on a terminal");
  if (arguments.channels.empty() && arguments.gains.empty())
    throw InputError("--gains", "no model", "--gains with --time-constants, or --channel for each channel");
}

/// A new file; one that is there is left as it is.
void write_new(const std::string& path, std::string_view text) {
  constexpr mode_t kAnybody = 0666;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAnybody);
  if (file < 0 && errno == EEXIST)
    throw InputError(path, "a file that is there", "a name for a new one");
  bool whole = file >= 0;
  while (whole && !text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    whole = written > 0;
    if (whole)
      text.remove_prefix(static_cast<std::size_t>(written));
  }
  const int error = errno;
  if (file >= 0 && ::close(file) == 0 && whole)
    return;
  if (file >= 0)
    ::unlink(path.c_str());
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", path, std::generic_category().message(error)));
}

/// Letters, digits, "_" and "-" of the name of the file.
std::string study_name(const std::string& output) {
  std::string name = output == "-" ? "my-plant" : std::filesystem::path(output).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; },
      '-');
  constexpr std::size_t kLongest = 64;
  return name.substr(0, kLongest);
}

ExitCode init(InitArguments arguments) {
  const bool to_stdout = arguments.output == "-";
  std::error_code no_status;
  if (!to_stdout && std::filesystem::exists(std::filesystem::symlink_status(arguments.output, no_status)))
    throw InputError(arguments.output, "a file that is there", "a name for a new one");
  if (arguments.cvs.empty() && arguments.mvs.empty() && ::isatty(STDIN_FILENO) == 1)
    ask(arguments);
  require_model(arguments);
  const std::string text = study_template(sketch_of(arguments, study_name(arguments.output)));
  const Study study = parse_study(text, arguments.output);
  const BasisCase basis = run_basis_case(study, qp_solver_factory("auto"));
  if (to_stdout)
    print_result(text);
  else
    write_new(arguments.output, text);
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
  add_path(app, "STUDY", options->output, "Study file to write, which must not be there; - for stdout")
      ->required();
  app.add_option("--cvs", options->cvs, "Controlled variables: names separated by commas, or how many");
  app.add_option("--mvs", options->mvs, "Manipulated variables, likewise");
  app.add_option("--mds", options->mds, "Measured disturbances, likewise");
  app.add_option("--unit", options->units, "Unit of a variable, NAME=UNIT")->allow_extra_args(false);
  app.add_option("--time-unit", options->time_unit, "Unit of time")->capture_default_str();
  app.add_option("--gains", options->gains,
                 "Gains, a row a CV, a column an MV or MD: '1 2; 3 4'; 0 for no channel");
  app.add_option("--time-constants", options->time_constants, "Time constants, likewise");
  app.add_option("--dead-times", options->dead_times, "Dead times, likewise; none without it");
  app.add_option(
         "--channel", options->channels,
         "A channel CV,INPUT=NUMERATOR/DENOMINATOR[@DEAD_TIME], coefficients in descending powers of s: "
         "y1,u1='4.05 / 50 1 @ 27'")
      ->allow_extra_args(false);
  app.add_option("--sample-time", options->sample_time, "Sample time; from the time constants without it");
  app.add_option("--range", options->ranges, "Range in which a CV is held, NAME=LOW:HIGH")
      ->allow_extra_args(false);
  app.add_option("--setpoint", options->setpoints,
                 "By how much the setpoint of a CV without a range moves, NAME=SIZE; 1 without it")
      ->allow_extra_args(false);
  app.add_option("--limits", options->limits, "Hard limits of an MV, NAME=LOW:HIGH")->allow_extra_args(false);
}

}  // namespace mpm
