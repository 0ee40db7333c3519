#include "bench/commands/sketch_words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "bench/parts/whole_number.hpp"

namespace mpm {
namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos
             ? std::string()
             : std::string(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
}

/// The pieces of a text between any of these characters, without the blanks around them. Empty pieces are
/// left out.
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

/// Reads variables, such as "y1, y2", or "2" for y1 and y2.
std::vector<PlantModel::Variable> variables(const std::string& text, char letter, const std::string& option) {
  std::vector<std::string> names = pieces(text, " ,");
  constexpr int kMost = 200;
  if (names.size() == 1 && names[0].find_first_not_of("0123456789") == std::string::npos) {
    const std::optional<std::int64_t> count = whole_number_in(names[0]);
    if (!count || *count > kMost)
      throw InputError(option, names[0], fmt::format("names, or a whole number from 0 to {}", kMost));
    names.clear();
    for (std::int64_t i = 1; i <= *count; ++i)
      names.push_back(fmt::format("{}{}", letter, i));
  }
  std::vector<PlantModel::Variable> list;
  for (const std::string& name : names)
    list.push_back({name, "1", ""});
  return list;
}

/// The place of a name in several lists of variables, counted through from the first list to the last.
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

/// Reads a matrix such as "1 2; 3 4": one row per CV, one column per MV or MD.
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

void read_matrices(const SketchWords& words, TransferMatrix& G) {
  const Eigen::MatrixXd gains = matrix_of(words.gains, G, "--gains");
  const Eigen::MatrixXd times = matrix_of(words.time_constants, G, "--time-constants");
  const Eigen::MatrixXd dead = words.dead_times.empty() ? Eigen::MatrixXd::Zero(G.rows(), G.cols()).eval()
                                                        : matrix_of(words.dead_times, G, "--dead-times");
  for (Eigen::Index i = 0; i < G.rows(); ++i)
    for (Eigen::Index j = 0; j < G.cols(); ++j)
      if (gains(i, j) != 0)
        G(i, j) = TransferFunction::first_order(gains(i, j), times(i, j), dead(i, j));
}

void read_channels(const SketchWords& words, PlantModel& plant) {
  for (const std::string& text : words.channels) {
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

}  // namespace

StudySketch sketch_of(const SketchWords& words, const std::string& name) {
  StudySketch sketch;
  PlantModel& plant = sketch.plant;
  plant.name = name;
  plant.title = name;
  plant.time_unit = words.time_unit;
  plant.cvs = variables(words.cvs, 'y', "--cvs");
  plant.mvs = variables(words.mvs, 'u', "--mvs");
  plant.mds = variables(words.mds, 'd', "--mds");
  const auto cv_count = static_cast<Eigen::Index>(plant.cvs.size());
  plant.G = TransferMatrix(cv_count, static_cast<Eigen::Index>(plant.mvs.size() + plant.mds.size()));
  for (const std::string& text : words.units) {
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
  if (!words.gains.empty() || !words.time_constants.empty() || !words.dead_times.empty())
    read_matrices(words, plant.G);
  read_channels(words, plant);
  sketch.sample_time = words.sample_time;
  sketch.ranges.resize(plant.cvs.size());
  for (const std::string& text : words.ranges) {
    const auto [cv, range] = assignment(text, "--range");
    sketch.ranges[place_of(cv, {&plant.cvs}, "--range")] = interval_of(range, "--range");
  }
  sketch.size = Eigen::VectorXd::Ones(cv_count);
  for (const std::string& text : words.setpoints) {
    const auto [cv, size] = assignment(text, "--setpoint");
    sketch.size(static_cast<Eigen::Index>(place_of(cv, {&plant.cvs}, "--setpoint"))) =
        number_of(size, "--setpoint");
  }
  sketch.mv_hard = Limits::none(static_cast<Eigen::Index>(plant.mvs.size()));
  for (const std::string& text : words.limits) {
    const auto [mv, limits] = assignment(text, "--limits");
    const auto place = static_cast<Eigen::Index>(place_of(mv, {&plant.mvs}, "--limits"));
    std::tie(sketch.mv_hard.lower(place), sketch.mv_hard.upper(place)) = interval_of(limits, "--limits");
  }
  return sketch;
}

}  // namespace mpm
