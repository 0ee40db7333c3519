#include "bench/commands/step_model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "results/records/record_file.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

constexpr const char* kTimeColumn = "time";
constexpr double kUnevenShare = 1e-6;  // of an interval

Eigen::VectorXd numbers_in(const RecordColumns& columns, std::size_t column) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(columns.rows()));
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const std::string& cell = columns.columns[column][row];
    const std::optional<double> number = columns.number(cell);
    if (!number || !std::isfinite(*number))
      throw InputError(fmt::format("{}:{}: {}", columns.file, columns.lines[row], columns.names[column]),
                       fmt::format("'{}'", cell), "a finite number in every row");
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
        "{}/{}: {} {:.4g}, dead time {:.4g}, {} {}; off by at most {:.2g} %{}\n", channel.cv, channel.input,
        integrates ? "integrates, rate" : "gain", integrates ? G.rate_gain() : G.static_gain(), G.dead_time(),
        lags, lags == 1 ? "lag" : "poles", 100 * channel.fit.largest_error,
        channel.function.step_coefficients() ? ", so that the study has the coefficients" : "");
  }
  return text;
}

StepModel read_step_model(const std::string& file, std::optional<double> interval) {
  RecordColumns columns = load_record_columns(file, DataOptions());
  const double between = step_interval_of(columns, interval);
  StepModel model{file, {}};
  for (std::size_t column = 0; column < columns.names.size(); ++column) {
    const std::string& name = columns.names[column];
    if (name == kTimeColumn)
      continue;
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos)
      throw InputError(file, fmt::format("the column '{}'", name), "CV/INPUT, or time");
    const Eigen::VectorXd coefficients = numbers_in(columns, column);
    try {
      const StepResponseFit fit = fit_step_coefficients(coefficients, between);
      model.channels.push_back({name.substr(0, slash), name.substr(slash + 1), fit,
                                fit.largest_error > kNegligibleOfPlant
                                    ? by_coefficients(fit, coefficients, between)
                                    : fit.channel});
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", file, name, error.what()));
    }
  }
  return model;
}

}  // namespace mpm
