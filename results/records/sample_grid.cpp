#include "results/records/sample_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "analysis/findings/monitored_loop.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kMostSamples = 1e6;

/// Returns the length of one unit of the stamps in time units of the plant.
double plant_units_in(const std::string& of_stamps, const std::string& of_plant, const std::string& file) {
  if (of_stamps.empty() || of_stamps == of_plant)
    return 1.0;
  const std::optional<double> plant_days = days_in(of_plant);
  if (!plant_days)
    throw InputError(fmt::format("{}: time stamps", file),
                     fmt::format("dates, or data.time_unit, and the time unit '{}' of the plant", of_plant),
                     "plant.time_unit s, min, h or d, or stamps that are numbers in its unit");
  return *days_in(of_stamps) / *plant_days;
}

}  // namespace

SampleGrid::SampleGrid(const Study& study, const StampedRows& rows) : data_(study.data), rows_(rows) {
  double last = rows.times.back();
  first_ = rows.times.front();
  if (!data_.period.empty()) {
    const auto [from, to] = stamps_of("period", data_.period);
    first_ = std::max(first_, from);
    last = std::min(last, to);
  }
  sample_ = study.controller.sample_time / plant_units_in(rows.unit, study.plant.time_unit, rows.file.file);
  const double count = std::floor((last - first_) / sample_ + 1e-6) + 1.0;
  if (!(count >= 2.0 && count <= kMostSamples))
    throw InputError(
        fmt::format("{}: time stamps", rows.file.file),
        fmt::format("{} to {}, {:.10g} samples of {:g} {}", rows.text(first_), rows.text(last),
                    std::max(count, 0.0), study.controller.sample_time, study.plant.time_unit),
        "2 to 1000000 samples of the controller: look at the stamps, data.time_unit, data.period");
  samples_ = static_cast<Eigen::Index>(count);
}

std::vector<std::string> SampleGrid::stamps() const {
  std::vector<std::string> stamps;
  for (Eigen::Index k = 0; k < samples_; ++k)
    stamps.push_back(rows_.text(at(k)));
  return stamps;
}

/// Returns the ends of a period in data.NAME, which are stamps as in the file, or dates.
std::pair<double, double> SampleGrid::stamps_of(const char* key,
                                                const std::vector<std::string>& period) const {
  const std::string place = fmt::format("data.{}", key);
  const std::vector<std::size_t> no_lines{0, 0};
  const TimeStamps stamps = parse_time_stamps({place, period, no_lines}, rows_.rules);
  if (stamps.calendar != rows_.calendar || !(stamps.times[0] < stamps.times[1]))
    throw InputError(place, fmt::format("[{}, {}]", period[0], period[1]),
                     fmt::format("two stamps of the form of the file, ascending, between {} and {}",
                                 rows_.text(rows_.times.front()), rows_.text(rows_.times.back())));
  return {stamps.times[0], stamps.times[1]};
}

/// Returns the sample to which a time belongs; -1 before all samples and samples_ after them.
Eigen::Index SampleGrid::nearest_sample(double time) const {
  const double sample = std::floor((time - first_) / sample_ + 0.5);
  return static_cast<Eigen::Index>(std::clamp(sample, -1.0, static_cast<double>(samples_)));
}

std::pair<Eigen::Index, Eigen::Index> SampleGrid::between(const char* key,
                                                          const std::vector<std::string>& period) const {
  const auto [from, to] = stamps_of(key, period);
  const Eigen::Index first = std::clamp<Eigen::Index>(nearest_sample(from), 0, samples_);
  const Eigen::Index end = std::clamp<Eigen::Index>(nearest_sample(to) + 1, 0, samples_);
  if (first >= end)
    throw InputError(
        fmt::format("data.{}", key), fmt::format("[{}, {}]", period[0], period[1]),
        fmt::format("a period between {} and {}", rows_.text(at(0)), rows_.text(at(samples_ - 1))));
  return {first, end};
}

Eigen::RowVectorXd SampleGrid::measured(const RowSignal& signal) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(samples_), count = sum;
  Eigen::RowVectorXd distance = Eigen::RowVectorXd::Constant(samples_, kInfinity);
  const bool mean = data_.cv_resampling == CvResampling::mean;
  for (std::size_t row = 0; row < signal.size(); ++row) {
    const Eigen::Index k = nearest_sample(rows_.times[row]);
    if (k < 0 || k >= samples_ || std::isnan(signal[row]))
      continue;
    const double off = std::abs(rows_.times[row] - at(k));
    if (!mean && off >= distance(k))
      continue;
    sum(k) = mean ? sum(k) + signal[row] : signal[row];
    count(k) = mean ? count(k) + 1.0 : 1.0;
    distance(k) = off;
  }
  return (count.array() > 0.0).select(sum.array() / count.array(), kNaN);
}

Eigen::RowVectorXd SampleGrid::held(const RowSignal& signal) const {
  Eigen::RowVectorXd values = Eigen::RowVectorXd::Constant(samples_, kNaN);
  double last = kNaN;
  std::size_t row = 0;
  for (Eigen::Index k = 0; k < samples_; ++k) {
    for (; row < signal.size() && rows_.times[row] < at(k) + 0.5 * sample_; ++row)
      last = std::isnan(signal[row]) ? last : signal[row];
    values(k) = last;
  }
  for (Eigen::Index k = samples_ - 2; k >= 0; --k)
    if (std::isnan(values(k)))
      values(k) = values(k + 1);
  return values;
}

Eigen::RowVectorXd SampleGrid::of_last_row(const RowSignal& signal) const {
  Eigen::RowVectorXd values = Eigen::RowVectorXd::Constant(samples_, kNaN);
  std::size_t row = 0;
  for (Eigen::Index k = 0; k < samples_; ++k) {
    while (row < signal.size() && rows_.times[row] < at(k) + 0.5 * sample_)
      ++row;
    if (row > 0)
      values(k) = signal[row - 1];
  }
  return values;
}

}  // namespace mpm
