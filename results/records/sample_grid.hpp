#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "results/records/stamped_rows.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// A signal of a file, one value a row; NaN: none.
using RowSignal = std::vector<double>;

/// The samples of the controller in the rows of a file: sample k at first + k Ts, from the first stamp of the
/// file or of data.period on.
class SampleGrid {
 public:
  /// Both must outlive it. Errors: InputError for a period that is none, and for fewer than two samples or
  /// more than a million.
  SampleGrid(const Study& study, const StampedRows& rows);

  Eigen::Index samples() const { return samples_; }
  /// The stamps of the samples, for people.
  std::vector<std::string> stamps() const;
  /// The samples of a period of [data], [first, end). Errors: InputError for a period that has none.
  std::pair<Eigen::Index, Eigen::Index> between(const char* key,
                                                const std::vector<std::string>& period) const;

  /// Of the values within half a sample time: the mean, or the nearest (data.cv_resampling); NaN: none.
  Eigen::RowVectorXd measured(const RowSignal& signal) const;
  /// The last value up to half a sample time after each sample; what is missing at the start is the first
  /// value.
  Eigen::RowVectorXd held(const RowSignal& signal) const;
  /// The value of the last row up to half a sample time after each sample, NaN where it has none.
  Eigen::RowVectorXd of_last_row(const RowSignal& signal) const;

 private:
  double at(Eigen::Index k) const { return first_ + static_cast<double>(k) * sample_; }
  Eigen::Index nearest_sample(double time) const;
  std::pair<double, double> stamps_of(const char* key, const std::vector<std::string>& period) const;

  const DataOptions& data_;
  const StampedRows& rows_;
  double first_ = 0.0;   ///< of the samples, unit of the stamps
  double sample_ = 1.0;  ///< sample time, unit of the stamps
  Eigen::Index samples_ = 0;
};

}  // namespace mpm
