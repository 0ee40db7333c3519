#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/method_rates.hpp"

namespace mpm {

/// The share of simulated records without a fault whose score may exceed the threshold of a verdict.
inline constexpr double kTrialFalseAlarms = 0.02;

/// How far to trust an answer on a record: the answers of the same method on similar simulated loops
/// (analysis/study_files/recorded_study.hpp), whose truth is known.
struct TrialFindings {
  /// trial_threshold() of the scores of the loops without a fault.
  double threshold;
  /// The same for each half of these loops: every second loop from the first one on, and from the second one
  /// on.
  std::array<double, 2> of_half;
  /// Over all simulated loops. A loop counts as flagged if its score is above threshold_for() (loops without
  /// a fault) or `threshold` (all others); without a threshold, if the method flags it.
  MethodRates rates = {};
  Rate as_high = {};      ///< loops without a fault whose score is as high as that of the record
  Rate same_source = {};  ///< of the flagged loops with the source that the answer names: it is the true one

  /// The threshold with which the `place`-th loop without a fault is compared. It is that of the other half,
  /// because the loop itself helped to set `threshold`.
  double threshold_for(std::size_t place) const { return of_half[1 - place % 2]; }
};

/// `said` is the answer on the record by the method in place `method` of the assessments of each of
/// `records`. `same_source` counts no loop if the answer names no source.
TrialFindings trial_findings(const Study& trial, std::size_t method, const RecordRange& records,
                             const AssessmentRecord& said);

/// The threshold of n scores s of loops without a fault at the rate `false_alarms` = a. It is the conformal
/// threshold or, if there are too few scores, that of an exponential tail above their median,
///
///   t = max s + b log(1 / ((n + 1) a)),   b the mean excess over the median of the scores above it
///
/// NaN without scores.
double trial_threshold(const std::vector<double>& healthy, double false_alarms = kTrialFalseAlarms);

}  // namespace mpm
