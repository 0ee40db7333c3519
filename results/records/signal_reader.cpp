#include "results/records/signal_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/implausible_values.hpp"
#include "results/records/opc_quality.hpp"
#include "results/records/quality_columns.hpp"

namespace mpm {
namespace {

constexpr std::size_t kWordsShown = 5;  // most words of a quality in a message
constexpr const char* kOpc = "opc";     // stands for OPC among the words of a good quality

bool is_one_of(const std::string& cell, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [cell = in_lower_case(cell)](const std::string& word) {
    return in_lower_case(word) == cell;
  });
}

std::string cut_name(const std::string& text) {
  return std::string(cut_utf8(text, kShownBytes));
}

/// Returns what a DataOptions group says about a variable; none if it says nothing.
template <class Value>
std::optional<Value> said_of(const std::map<std::string, Value>& group, const std::string& variable) {
  const auto found = group.find(variable);
  return found == group.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

SignalReader::SignalReader(const Study& study, RecordColumns& file, std::vector<std::string>& warnings)
    : study_(study), data_(study.data), file_(file), warnings_(warnings) {
  for (const std::string& name : data_.stored_on_change)
    if (const auto quality = said_of(data_.quality, name))
      fill(file_.column(where("quality", name), *quality));
}

std::string SignalReader::where(const std::string& key, const std::string& variable) const {
  return fmt::format("{}: data.{}.{}", file_.file, key, variable);
}

std::size_t SignalReader::column_of(const std::string& variable, const char* prefix) const {
  if (const auto tag = said_of(data_.tags, variable))
    return file_.column(where("tags", variable), *tag);
  if (const auto exported = file_.find(fmt::format("{}.{}", prefix, variable)))
    return *exported;
  if (const auto column = file_.find(variable))
    return *column;
  return file_.column(where("tags", variable), variable);
}

bool SignalReader::on_change(const std::string& variable) const {
  const std::vector<std::string>& names = data_.stored_on_change;
  return std::find(names.begin(), names.end(), variable) != names.end();
}

/// Fills each empty cell with the one above it.
void SignalReader::fill(std::size_t column) {
  std::vector<std::string>& cells = file_.columns[column];
  for (std::size_t row = 1; row < cells.size(); ++row)
    if (cells[row].empty())
      cells[row] = cells[row - 1];
}

RowSignal SignalReader::numbers(std::size_t column, const std::string& variable) {
  return numbers(column, variable, false);
}

/// `measured` tells whether the column is a CV or an MD itself.
RowSignal SignalReader::numbers(std::size_t column, const std::string& variable, bool measured) {
  const double zero = said_of(data_.operating_point, variable).value_or(0.0);
  const double scale = said_of(data_.scale, variable).value_or(1.0);
  RowSignal signal(file_.rows(), kNaN);
  std::size_t texts = 0, first_text = 0, filled = 0;
  for (std::size_t row = 0; row < file_.rows(); ++row) {
    const std::string& cell = file_.columns[column][row];
    if (const auto value = file_.number(cell))
      signal[row] = *value;
    else if (!cell.empty() && texts++ == 0)
      first_text = row;
    filled += cell.empty() ? 0 : 1;
  }
  const std::string name = cut_name(file_.names[column]);
  const std::string_view text = texts == 0 ? "" : cut_utf8(file_.columns[column][first_text], kShownBytes);
  if (texts == filled)
    throw InputError(fmt::format("{}: column '{}', for {}", file_.file, name, variable),
                     texts == 0 ? std::string("no value") : fmt::format("no number, but '{}'", text),
                     file_.decimal == '.' ? "numbers with a decimal point; data.decimal = \",\" for commas"
                                          : "numbers with a decimal comma; data.decimal = \".\" for points");
  if (texts > 0)
    warnings_.push_back(
        fmt::format("column '{}': {} cells are no numbers and count as missing, the first is '{}' in line {}",
                    name, texts, text, file_.lines[first_text]));
  drop_implausible(column, variable, measured, signal);
  for (double& value : signal)
    value = scale * (value - zero);
  return signal;
}

RowSignal SignalReader::holding(const std::string& name, const char* prefix, RowSignal signal) const {
  const std::vector<std::string>& cells = file_.columns[column_of(name, prefix)];
  for (std::size_t row = 1; row < signal.size(); ++row)
    if (cells[row].empty())
      signal[row] = signal[row - 1];
  return signal;
}

RowSignal SignalReader::variable(const std::string& name, const char* prefix) {
  const std::size_t column = column_of(name, prefix);
  const std::vector<PlantModel::Variable>& mvs = study_.plant.mvs;
  const bool is_mv =
      std::any_of(mvs.begin(), mvs.end(), [&](const PlantModel::Variable& mv) { return mv.name == name; });
  RowSignal signal = numbers(column, name, !is_mv);
  drop_bad_quality(name, column, signal);
  return signal;
}

/// Returns the hard limits of a variable; infinite if it has none.
std::pair<double, double> SignalReader::hard_limits(const std::string& variable) const {
  std::pair<double, double> found{-kInfinity, kInfinity};
  const auto look = [&](const std::vector<PlantModel::Variable>& variables, const Limits& limits) {
    for (std::size_t i = 0; i < variables.size(); ++i)
      if (variables[i].name == variable)
        found = {limits.lower(static_cast<Eigen::Index>(i)), limits.upper(static_cast<Eigen::Index>(i))};
  };
  look(study_.plant.cvs, study_.controller.cv_hard);
  look(study_.plant.mvs, study_.controller.mv_hard);
  return found;
}

/// Removes values that cannot be measurements. The signal is still as recorded, because -9999 has its meaning
/// only there.
void SignalReader::drop_implausible(std::size_t column, const std::string& variable, bool measured,
                                    RowSignal& signal) {
  const double zero = said_of(data_.operating_point, variable).value_or(0.0);
  const double scale = said_of(data_.scale, variable).value_or(1.0);
  const std::pair<double, double> limits = hard_limits(variable);
  const double one = zero + limits.first / scale, other = zero + limits.second / scale;
  const std::vector<std::size_t> rows =
      implausible_rows(signal, std::min(one, other), std::max(one, other), measured);
  if (rows.empty())
    return;
  for (const std::size_t row : rows)
    signal[row] = kNaN;
  warnings_.push_back(fmt::format(
      "column '{}': {} values cannot be measurements and count as missing, the first is '{}' in line {}",
      cut_name(file_.names[column]), rows.size(), cut_utf8(file_.columns[column][rows.front()], kShownBytes),
      file_.lines[rows.front()]));
}

bool SignalReader::has_numbers(std::size_t column) const {
  const std::vector<std::string>& cells = file_.columns[column];
  return std::any_of(cells.begin(), cells.end(),
                     [&](const std::string& cell) { return file_.number(cell).has_value(); });
}

struct SignalReader::BadRows {
  std::vector<std::size_t> rows;
  std::map<std::string, std::size_t> words;  ///< words, each with its number of rows

  /// "'Bad' (20 rows), 'Out of range' (1 rows)"
  std::string text() const {
    std::vector<std::string> shown;
    for (const auto& [word, count] : words)
      shown.push_back(shown.size() < kWordsShown ? fmt::format("'{}' ({} rows)", word, count) : "others");
    return fmt::format("{}", fmt::join(shown, ", "));
  }
};

/// Finds the rows of bad quality. In a `named` column an empty cell is not good.
SignalReader::BadRows SignalReader::bad_rows(std::size_t quality, const RowSignal& signal, bool named) const {
  const bool opc = is_one_of(kOpc, data_.good_quality);
  const OpcCodes codes = opc ? opc_codes(file_, quality) : OpcCodes::da;
  BadRows bad;
  for (std::size_t row = 0; row < signal.size(); ++row) {
    const std::string& cell = file_.columns[quality][row];
    const bool nothing = cell.empty() && (!named || std::isnan(signal[row]));  // a row of other variables
    if (nothing || is_word(cell, data_.good_quality) || (opc && is_good_opc(file_, cell, codes)))
      continue;
    bad.rows.push_back(row);
    if (const std::string word = cut_name(cell); bad.words.size() <= kWordsShown || bad.words.contains(word))
      ++bad.words[word];
  }
  return bad;
}

void SignalReader::drop_bad_quality(const std::string& variable, std::size_t column, RowSignal& signal) {
  const auto tag = said_of(data_.quality, variable);
  if (!tag) {
    const auto found = quality_column_of(file_, column);
    if (found && !is_named(*found))
      look_at_quality(variable, *found, signal);
    return;
  }
  const std::size_t quality = file_.column(where("quality", variable), *tag);
  const BadRows bad = bad_rows(quality, signal, true);
  for (const std::size_t row : bad.rows)
    signal[row] = kNaN;
  if (!signal.empty() && bad.rows.size() == signal.size())
    throw InputError(where("quality", variable), fmt::format("no row of good quality, but {}", bad.text()),
                     fmt::format("one of data.good_quality: {}{}", fmt::join(data_.good_quality, ", "),
                                 bad.words.size() == 1 && is_word(bad.words.begin()->first, {"0"})
                                     ? "; in OPC UA 0 is good: good_quality = [\"0\"]"
                                     : ""));
  if (!bad.rows.empty())
    warnings_.push_back(fmt::format(
        "{} is missing in {} of {} rows, whose quality is none of data.good_quality ({}): {}", variable,
        bad.rows.size(), signal.size(), fmt::join(data_.good_quality, ", "), bad.text()));
}

/// Applies a quality column that was found and that nobody has named.
void SignalReader::look_at_quality(const std::string& variable, std::size_t quality, RowSignal& signal) {
  if (on_change(variable))
    fill(quality);
  const std::string name = cut_name(file_.names[quality]);
  const BadRows bad = bad_rows(quality, signal, false);
  const bool says_nothing = bad.rows.size() == signal.size() && bad.words.size() == 1;
  if (bad.rows.empty())
    return;
  const std::size_t line = file_.lines[bad.rows.front()];
  if (are_qualities(file_, quality)) {
    for (const std::size_t row : bad.rows)
      signal[row] = kNaN;
    warnings_.push_back(fmt::format(
        "{} is missing in {} of {} rows, the first in line {}, in which the column '{}' has none of "
        "data.good_quality ({}): {}. Nothing names this column: data.quality = {{{} = \"{}\"}} does",
        variable, bad.rows.size(), signal.size(), line, name, fmt::join(data_.good_quality, ", "), bad.text(),
        variable, name));
  } else if (bad.words.size() <= kWordsShown && !says_nothing) {
    warnings_.push_back(fmt::format(
        "{}: the column '{}' has {}, the first in line {}. If this is its quality, name the column in "
        "data.quality, and the good words in data.good_quality",
        variable, name, bad.text(), line));
  }
}

void SignalReader::tell_unnamed() {
  const std::vector<PlantModel::Variable>&cvs = study_.plant.cvs, &mvs = study_.plant.mvs;
  for (std::size_t cv = 0; cv < cvs.size(); ++cv) {
    const std::string& name = cvs[cv].name;
    if (study_.controller.has_setpoint(static_cast<Eigen::Index>(cv)) && !data_.setpoint.contains(name) &&
        !file_.find("y_set." + name))
      tell_beside(name, "y", "SP", "setpoint", "the setpoint of the study counts throughout");
  }
  for (const auto* variables : {&cvs, &mvs})
    for (const PlantModel::Variable& variable : *variables)
      if (!data_.mode.contains(variable.name))
        tell_beside(variable.name, variables == &mvs ? "u" : "y", "MODE", "mode",
                    "what operators did with it counts as the controller's");
}

void SignalReader::tell_beside(const std::string& variable, const char* prefix, const char* ending,
                               const char* key, const char* why) {
  const auto found = column_beside(file_, column_of(variable, prefix), ending);
  if (!found || is_named(*found))
    return;
  const std::string name = cut_name(file_.names[*found]);
  warnings_.push_back(
      fmt::format("the column '{}' stands beside that of {}, and nothing names it, so that {}: "
                  "data.{} = {{{} = \"{}\"}} does",
                  name, variable, why, key, variable, name));
}

/// Tells whether [data] uses this column for something else.
bool SignalReader::is_named(std::size_t column) const {
  const std::string& name = file_.names[column];
  const auto names = [&](const DataOptions::Names& group) {
    return std::any_of(group.begin(), group.end(), [&](const auto& each) { return each.second == name; });
  };
  return names(data_.tags) || names(data_.setpoint) || names(data_.lower) || names(data_.upper) ||
         names(data_.y_sim) || names(data_.target) || names(data_.mode) || data_.controller_on == name ||
         data_.time == name || data_.date == name || is_one_of(name, data_.candidates);
}

/// Tells whether the cell is one of these words, or a number that equals one of them.
bool SignalReader::is_word(const std::string& cell, const std::vector<std::string>& words) const {
  if (is_one_of(cell, words))
    return true;
  const auto value = file_.number(cell);
  return value && is_one_of(fmt::format("{:g}", *value), words);
}

RowSignal SignalReader::controller_on() const {
  return is_on(file_.column(file_.file + ": data.controller_on", data_.controller_on), data_.on_values);
}

RowSignal SignalReader::in_use(const std::string& variable) const {
  return is_on(file_.column(where("mode", variable), data_.mode.at(variable)), data_.mode_on);
}

RowSignal SignalReader::is_on(std::size_t column, const std::vector<std::string>& words) const {
  RowSignal on;
  for (const std::string& cell : file_.columns[column])
    on.push_back(cell.empty() ? kNaN : is_word(cell, words) ? 1.0 : 0.0);
  return on;
}

}  // namespace mpm
