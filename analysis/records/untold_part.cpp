#include "analysis/records/untold_part.hpp"

#include <algorithm>
#include <cmath>

#include "plants/linear/settling_time.hpp"

namespace mpm {
namespace {

constexpr double kFarLarger = 2.0;  // ratio of mean squares
constexpr double kAlike = 0.02;     // of a time constant: two channels that differ less settle alike

/// The time constants of the channels of a CV, in samples. Those that are alike appear once.
std::vector<double> memories_of(const Study& study, Eigen::Index cv) {
  std::vector<double> all;
  for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input)
    if (const double sum = sum_of_time_constants(study.assessed_channel(cv, input)); sum > 0.0)
      all.push_back(sum / study.controller.sample_time);
  std::sort(all.begin(), all.end());
  std::vector<double> distinct;
  for (const double each : all)
    if (distinct.empty() || each > (1.0 + kAlike) * distinct.back())
      distinct.push_back(each);
  return distinct;
}

}  // namespace

std::vector<Eigen::Index> starts_after_unknown(const Eigen::MatrixXd& y, Eigen::Index settling) {
  std::vector<Eigen::Index> starts;
  Eigen::Index without = 0;
  for (Eigen::Index k = 0; k < y.cols(); ++k) {
    const bool is_there = !y.col(k).array().isNaN().all();
    if (is_there && without > 0 && without >= settling)
      starts.push_back(k);
    without = is_there ? 0 : without + 1;
  }
  return starts;
}

Eigen::MatrixXd untold_columns(const Study& study, Eigen::Index cv, const std::vector<Eigen::Index>& starts,
                               Eigen::Index samples) {
  const std::vector<double> memories = memories_of(study, cv);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(samples, 1 + std::ssize(memories) * std::ssize(starts));
  columns.col(0).setOnes();
  Eigen::Index column = 1;
  for (const Eigen::Index start : starts)
    for (const double memory : memories) {
      for (Eigen::Index k = start; k < samples; ++k)
        columns(k, column) = std::exp(-static_cast<double>(k - start) / memory);
      ++column;
    }
  return columns;
}

bool shows_a_past(const AssessedLoop& loop, Eigen::Index settling) {
  if (settling <= 0 || 2 * settling > loop.samples())
    return false;
  const auto mean = [](const Eigen::ArrayXd& values) {
    const auto is_there = !values.isNaN();
    return is_there.select(values, 0.0).sum() / std::max(1.0, is_there.cast<double>().sum());
  };
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
    const Eigen::ArrayXd e = (loop.y.row(cv) - loop.y_sim.row(cv)).transpose();
    const Eigen::ArrayXd later = e.tail(e.size() - settling);
    const double centre = mean(later);
    if (mean((e.head(settling) - centre).square()) > kFarLarger * mean((later - centre).square()))
      return true;
  }
  return false;
}

}  // namespace mpm
