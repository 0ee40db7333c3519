#pragma once

#include <Eigen/Core>

#include "plants/output_sampling.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/study/record_options.hpp"

// The times of the rows of a record: row k of a variable has its value at (k + shift) Ts, or its mean over
// the sample time that ends there.

namespace mpm {

/// When a variable is sampled for the rows of a record.
struct RowTime {
  OutputSampling sampling = OutputSampling::snapshot;
  double shift = 0.0;  ///< samples; above 0: a row holds a later value of the variable

  /// The sample at or after the time of row 0, and its distance from that time in samples, from 0 to below 1.
  Eigen::Index sample() const;
  double delay() const;
  bool is_at_samples() const { return sampling == OutputSampling::snapshot && delay() == 0.0; }
};

/// The row time of the CV, MV or MD with this index. MVs and MDs are held over a sample, and never averaged.
RowTime row_time(const RecordOptions& record, VariableSort sort, Eigen::Index variable);

/// Rows from `at_samples` (N or more), the values at each sample of a signal that is already late by delay():
/// row k has the value of sample k + sample(), or the nearest one at the ends of the record.
Eigen::RowVectorXd rows_of(const RowTime& time, const Eigen::Ref<const Eigen::RowVectorXd>& at_samples,
                           Eigen::Index rows);

/// Rows of a signal that is held from each sample to the next one.
Eigen::RowVectorXd rows_of_held(const RowTime& time, const Eigen::Ref<const Eigen::RowVectorXd>& signal);

/// Rows of a signal that is a straight line from each sample to the next one.
Eigen::RowVectorXd rows_of_line(const RowTime& time, const Eigen::Ref<const Eigen::RowVectorXd>& signal);

/// The signal delayed by s samples (below 0: advanced), linear between samples; beyond the ends it has its
/// first or last value.
Eigen::RowVectorXd late_by(const Eigen::Ref<const Eigen::RowVectorXd>& signal, double s);

}  // namespace mpm
