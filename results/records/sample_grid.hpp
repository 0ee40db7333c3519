#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "results/records/stamped_rows.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// A signal of a file, one value per row; NaN: no value.
using RowSignal = std::vector<double>;

/// Places the samples of the controller among the rows of a file: sample k is at first + k Ts. The first
/// sample is at the first stamp of the file, or of data.period.
class SampleGrid {
 public:
  /// `study` and `rows` must outlive the grid. Errors: InputError for an invalid period, and for fewer than
  /// two or more than a million samples.
  SampleGrid(const Study& study, const StampedRows& rows);

  Eigen::Index samples() const { return samples_; }
  /// Returns the stamps of the samples, for people.
  std::vector<std::string> stamps() const;
  /// Returns the samples [first, end) of a period of [data]. Errors: InputError if the period has no samples.
  std::pair<Eigen::Index, Eigen::Index> between(const char* key,
                                                const std::vector<std::string>& period) const;

  /// Returns the mean of the values within half a sample time of each sample, or the nearest of them
  /// (data.cv_resampling); NaN if there are none.
  Eigen::RowVectorXd measured(const RowSignal& signal) const;
  /// Returns the last value up to half a sample time after each sample. Before the first value, that one is
  /// used.
  Eigen::RowVectorXd held(const RowSignal& signal) const;
  /// Returns the value of the last row up to half a sample time after each sample; NaN if that row has none.
  Eigen::RowVectorXd of_last_row(const RowSignal& signal) const;

 private:
  double at(Eigen::Index k) const { return first_ + static_cast<double>(k) * sample_; }
  Eigen::Index nearest_sample(double time) const;
  std::pair<double, double> stamps_of(const char* key, const std::vector<std::string>& period) const;

  const DataOptions& data_;
  const StampedRows& rows_;
  double first_ = 0.0;   ///< time of the first sample, in the unit of the stamps
  double sample_ = 1.0;  ///< sample time, in the unit of the stamps
  Eigen::Index samples_ = 0;
};

}  // namespace mpm
