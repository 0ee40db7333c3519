#include "bench/commands/step_model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/error.hpp"
#include "plants/linear/step_response_fit.hpp"
#include "results/records/record_file.hpp"

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

/// In the way of --channel.
std::string channel_words(const std::string& name, const TransferFunction& channel) {
  return fmt::format("{}={} / {} @ {}", name, fmt::join(channel.numerator(), " "),
                     fmt::join(channel.denominator(), " "), channel.dead_time());
}

}  // namespace

std::string take_step_model(SketchWords& words, const std::string& file, std::optional<double> interval) {
  RecordColumns columns = load_record_columns(file, DataOptions());
  const double between = step_interval_of(columns, interval);
  const std::vector<std::string> mds = pieces(words.mds, " ,");
  std::vector<std::string> cvs, mvs, channels;
  std::string report;
  for (std::size_t column = 0; column < columns.names.size(); ++column) {
    const std::string& name = columns.names[column];
    const std::size_t slash = name.find('/');
    if (name == kTimeColumn)
      continue;
    if (slash == std::string::npos)
      throw InputError(file, fmt::format("the column '{}'", name), "CV/INPUT, or time");
    const std::string cv = name.substr(0, slash), input = name.substr(slash + 1);
    add_once(cvs, cv);
    if (std::find(mds.begin(), mds.end(), input) == mds.end())
      add_once(mvs, input);
    const Eigen::VectorXd coefficients = numbers_in(columns, column);
    StepResponseFit fit;
    try {
      fit = fit_step_coefficients(coefficients, between);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", file, name, error.what()));
    }
    if (fit.channel.is_zero())
      continue;
    channels.push_back(channel_words(fmt::format("{},{}", cv, input), fit.channel));
    report += fmt::format("{}: gain {:.4g}, dead time {:.4g}, {} {}; off by at most {:.2g} %\n", name,
                          fit.channel.static_gain(), fit.channel.dead_time(), fit.channel.order(),
                          fit.channel.order() == 1 ? "lag" : "poles", 100 * fit.largest_error);
  }
  if (words.cvs.empty())
    words.cvs = fmt::format("{}", fmt::join(cvs, ","));
  if (words.mvs.empty())
    words.mvs = fmt::format("{}", fmt::join(mvs, ","));
  words.channels.insert(words.channels.begin(), channels.begin(), channels.end());  // --channel wins
  return report;
}

}  // namespace mpm
