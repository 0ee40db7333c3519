#include "bench/commands/step_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/record_file.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr const char* kTimeColumn = "time";
constexpr double kUnevenShare = 1e-6;  // of an interval
constexpr std::size_t kMostVariables = 200;

Eigen::VectorXd numbers_in(const RecordColumns& columns, std::size_t column) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(columns.rows()));
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const std::string& cell = columns.columns[column][row];
    const std::optional<double> number = columns.number(cell);
    if (!number || !std::isfinite(*number))
      throw InputError(fmt::format("{}:{}: {}", columns.file, columns.lines[row], columns.names[column]),
                       fmt::format("'{}'", cut_utf8(cell, kShownBytes)), "a finite number in every row");
    values(static_cast<Eigen::Index>(row)) = *number;
  }
  return values;
}

/// The time between two rows. Drops a first row at time 0.
double step_interval_of(RecordColumns& columns, std::optional<double> stated) {
  const std::optional<std::size_t> time = columns.find(kTimeColumn);
  if (!time) {
    if (!stated)
      throw InputError(
          "--step-interval", "nothing",
          fmt::format("the time between two rows of {}, or a column '{}'", columns.file, kTimeColumn));
    return *stated;
  }
  if (columns.rows() > 0 && columns.number(columns.columns[*time][0]) == 0.0) {
    std::vector<std::size_t> others(columns.rows() - 1);
    for (std::size_t row = 0; row < others.size(); ++row)
      others[row] = row + 1;
    columns.keep_rows(others);
  }
  const Eigen::VectorXd times = numbers_in(columns, *time);
  const double interval = times.size() > 0 ? times(0) : 0.0;
  for (Eigen::Index row = 0; row < times.size(); ++row)
    if (!(interval > 0) ||
        std::abs(times(row) - interval * static_cast<double>(row + 1)) > kUnevenShare * interval)
      throw InputError(
          fmt::format("{}:{}: {}", columns.file, columns.lines[static_cast<std::size_t>(row)], kTimeColumn),
          fmt::format("{}", times(row)),
          "times after the step, one interval after the other, from 0 or from one interval on");
  if (stated && std::abs(*stated - interval) > kUnevenShare * interval)
    throw InputError("--step-interval", fmt::format("{}", *stated),
                     fmt::format("{}, which the column '{}' has", interval, kTimeColumn));
  return interval;
}

/// Two counts of the digits of a number: those behind its point, less its power of ten, and those from its
/// first nonzero digit on.
std::pair<int, int> digits_of(const std::string& cell, char decimal) {
  const std::size_t end = std::min(cell.find_first_of("eE"), cell.size());
  const std::size_t point = std::min(cell.find(decimal), end), first = cell.find_first_of("123456789");
  const int power = end < cell.size() ? std::atoi(cell.c_str() + end + 1) : 0;
  const auto count = [&](std::size_t from) {
    return static_cast<int>(std::count_if(cell.begin() + static_cast<std::ptrdiff_t>(std::min(from, end)),
                                          cell.begin() + static_cast<std::ptrdiff_t>(end),
                                          [](char c) { return c >= '0' && c <= '9'; }));
  };
  return {count(point) - power, count(first)};
}

/// By how much the coefficients in a column may be off: half of the last digit that the column shows, whether
/// it shows so many digits behind the point or so many in all. At least what a search can find, and at most
/// what is negligible.
Eigen::VectorXd tolerances_of(const RecordColumns& columns, std::size_t column,
                              const Eigen::VectorXd& coefficients) {
  constexpr double kOfSearch = 1e-11;  // of the largest coefficient
  constexpr double kHalf = 0.5 + 1e-9;
  int behind_point = 0, in_all = 1;
  for (const std::string& cell : columns.columns[column]) {
    const auto [behind, all] = digits_of(cell, columns.decimal);
    behind_point = std::max(behind_point, behind);
    in_all = std::max(in_all, all);
  }
  const double largest = coefficients.cwiseAbs().maxCoeff(), fixed = std::pow(10.0, -behind_point);
  const auto tolerance = [&](double value) {
    const double floating =
        value == 0.0 ? 0.0 : std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1.0 - in_all);
    return std::clamp(kHalf * std::max(fixed, floating), kOfSearch * largest, kNegligibleOfPlant * largest);
  };
  return coefficients.unaryExpr(tolerance);
}

/// The CV and the input in a heading "CV/INPUT".
std::pair<std::string, std::string> channel_in(const std::string& heading, const std::string& file) {
  const std::size_t slash = heading.find('/');
  const auto trimmed = [](std::string text) {
    text.erase(0, text.find_first_not_of(" \t"));
    return text.erase(text.find_last_not_of(" \t") + 1);
  };
  const auto refuse = [&](const char* allowed) {
    throw InputError(file, fmt::format("the column '{}'", cut_utf8(heading, kShownBytes)), allowed);
  };
  std::pair<std::string, std::string> channel;
  if (slash != std::string::npos)
    channel = {trimmed(heading.substr(0, slash)), trimmed(heading.substr(slash + 1))};
  if (channel.first.empty() || channel.second.empty())
    refuse("CV/INPUT, or time");
  for (const std::string& name : {channel.first, channel.second})
    if (!is_name(name))
      refuse("CV/INPUT, or time; names of 1 to 64 letters, digits, '_' and '-'");
  return channel;
}

/// A column of a file that is a channel.
struct ChannelColumn {
  std::pair<std::string, std::string> channel;
  std::size_t column;
};

/// All columns except the time. All are checked before any of them is fitted.
std::vector<ChannelColumn> channel_columns(const RecordColumns& columns, std::optional<std::size_t> time,
                                           const std::string& file) {
  std::vector<ChannelColumn> found;
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  std::set<std::string> cvs, inputs;
  for (std::size_t column = 0; column < columns.names.size(); ++column) {
    if (column == time)
      continue;
    const std::string& name = columns.names[column];
    const auto channel = channel_in(name, file);
    if (const auto first = places.emplace(channel, column); !first.second)
      throw InputError(
          fmt::format("{}: {}", file, cut_utf8(name, kShownBytes)),
          fmt::format("the columns {} and {} for this channel", first.first->second + 1, column + 1),
          "one column for each channel");
    cvs.insert(channel.first);
    inputs.insert(channel.second);
    found.push_back({channel, column});
  }
  if (std::max(cvs.size(), inputs.size()) > kMostVariables)
    throw InputError(file, fmt::format("{} CVs and {} inputs", cvs.size(), inputs.size()),
                     fmt::format("at most {} of each", kMostVariables));
  for (const std::string& cv : cvs)
    if (inputs.contains(cv))
      throw InputError(file, fmt::format("'{}' as a CV and as an input", cv), "a name for each variable");
  return found;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end())
    names.push_back(name);
}

/// The place of a variable of the plant.
Eigen::Index place_in(const std::vector<std::string>& names, const std::string& name,
                      const std::string& column) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(column, with_nearest(name, names), fmt::format("{}", fmt::join(names, ", ")));
  return found - names.begin();
}

StepModel::Channel fitted(const std::pair<std::string, std::string>& channel,
                          const Eigen::VectorXd& coefficients, double interval,
                          const Eigen::VectorXd& tolerances) {
  StepResponseFit fit = fit_step_coefficients(coefficients, interval, tolerances.maxCoeff());
  const std::optional<TransferFunction> shorter =
      with_fewest_digits(fit.channel, coefficients, interval, tolerances);
  fit.channel = shorter.value_or(fit.channel);
  const bool negligible = fit.largest_error <= kNegligibleOfPlant;
  return {channel.first, channel.second, fit,
          shorter || negligible ? fit.channel : by_coefficients(fit, coefficients, interval),
          shorter.has_value()};
}

}  // namespace

std::vector<std::string> StepModel::cvs() const {
  std::vector<std::string> names;
  for (const Channel& channel : channels)
    add_once(names, channel.cv);
  return names;
}

std::vector<std::string> StepModel::inputs_but(const std::vector<std::string>& mds) const {
  std::vector<std::string> names;
  for (const Channel& channel : channels)
    if (std::find(mds.begin(), mds.end(), channel.input) == mds.end())
      add_once(names, channel.input);
  return names;
}

void StepModel::put_into(PlantModel& plant) const {
  for (const Channel& channel : channels) {
    const std::string column = fmt::format("{}: {}/{}", file, channel.cv, channel.input);
    TransferFunction& place = plant.G(place_in(variable_names(plant.cvs), channel.cv, column),
                                      place_in(input_names(plant), channel.input, column));
    if (place.is_zero())
      place = channel.function;
  }
}

std::string StepModel::report() const {
  std::string text;
  for (const Channel& channel : channels) {
    const TransferFunction& G = channel.fit.channel;
    const bool integrates = G.is_integrating();
    const Eigen::Index lags = G.order() - (integrates ? 1 : 0);
    text += fmt::format(
        "{}/{}: {} {:.4g}, dead time {:.4g}, {} {}; {}{}\n", channel.cv, channel.input,
        integrates ? "integrates, rate" : "gain", integrates ? G.rate_gain() : G.static_gain(), G.dead_time(),
        lags, lags == 1 ? "lag" : "poles",
        channel.exact ? "exact" : fmt::format("off by at most {:.2g} %", 100 * channel.fit.largest_error),
        channel.function.step_coefficients() ? ", so that the study has the coefficients" : "");
  }
  return text;
}

StepModel read_step_model(const std::string& file, std::optional<double> interval) {
  RecordColumns columns = load_record_columns(file, DataOptions());
  const double between = step_interval_of(columns, interval);
  if (columns.rows() == 0)
    throw InputError(file, "no row behind time 0", "coefficients 1, 2, ... intervals after the step");
  StepModel model{file, between, {}};
  for (const ChannelColumn& each : channel_columns(columns, columns.find(kTimeColumn), file)) {
    const Eigen::VectorXd coefficients = numbers_in(columns, each.column);
    try {
      model.channels.push_back(
          fitted(each.channel, coefficients, between, tolerances_of(columns, each.column, coefficients)));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", file, columns.names[each.column], error.what()));
    }
  }
  return model;
}

}  // namespace mpm
