#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/method_rates.hpp"

namespace mpm {

/// The share of simulated records without a fault that the threshold of a verdict leaves above it.
inline constexpr double kTrialFalseAlarms = 0.02;

/// How far to trust an answer on a record: the answers of the same method on simulated loops like it
/// (analysis/study_files/recorded_study.hpp), whose truth is known.
struct TrialFindings {
  /// trial_threshold() of the scores of the loops without a fault.
  double threshold;
  /// The same of every second loop without a fault, from the first and from the second one on.
  std::array<double, 2> of_half;
  /// Over all of these loops. One counts as flagged if its score is above threshold_for(); without one if the
  /// method flags it.
  MethodRates rates = {};
  Rate as_high = {};      ///< loops without a fault whose score is as high as that of the record
  Rate same_source = {};  ///< of the flagged loops with the source that the answer names, those that have it

  /// The threshold against which the `place`-th loop without a fault counts where something is said about
  /// these loops: that of the other half, because it has helped to set `threshold` itself.
  double threshold_for(std::size_t place) const { return of_half[1 - place % 2]; }
};

/// `said` is the answer on the record by the method in place `method` of the assessments of each of
/// `records`. Nothing is counted in `same_source` when the answer names no source.
TrialFindings trial_findings(const Study& trial, std::size_t method, const RecordRange& records,
                             const AssessmentRecord& said);

/// The threshold of n scores s of loops without a fault at `false_alarms` = a: the conformal one, or, with
/// too few of them, that of a tail above their median which is exponential,
///
///   t = max s + b log(1 / ((n + 1) a)),   b the mean excess over the median of the scores above it
///
/// NaN without scores.
double trial_threshold(const std::vector<double>& healthy, double false_alarms = kTrialFalseAlarms);

}  // namespace mpm
