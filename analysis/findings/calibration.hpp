#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/record_range.hpp"

// Thresholds that give every method the same rate of false alarms, so that methods can be compared by what
// they detect at it. They are computed from the scores of loops of another seed than that of the study.

namespace mpm {

/// What the methods of a study say about one calibration loop.
struct CalibrationLoop {
  ExperimentKind kind;  ///< healthy, or ud
  /// One a method, in their order; NaN: no verdict, -infinity: a verdict without a score.
  std::vector<double> scores;
};

/// The calibration loops of a study, in the order of their index (scenarios/loop/calibration.hpp).
struct Calibration {
  std::uint64_t seed = 0;
  std::vector<CalibrationLoop> loops;
};

/// CalibrationLoop::scores of one answer.
double calibration_score(const AssessmentRecord& said);

/// The scores of these experiments of calibration_study().
Calibration calibration_of(const Study& loops, const RecordRange& records);

/// A threshold on the score of a method: loops above it are flagged.
struct CalibratedThreshold {
  std::optional<double> value;  ///< conformal_threshold(); none: of too few loops
  std::int64_t loops = 0;       ///< with a verdict, that it is computed from

  bool exceeded_by(double score) const { return value && score > *value; }
};

/// How often a threshold is drawn anew: as often as a letter of a board can count.
inline constexpr int kRedraws = 63;

/// The calibrated thresholds of one method.
struct CalibratedThresholds {
  CalibratedThreshold at_01;    ///< 1 % of the healthy loops flagged at most
  CalibratedThreshold at_05;    ///< 5 %
  CalibratedThreshold chosen;   ///< calibration.false_alarms of the study
  CalibratedThreshold not_mpm;  ///< 5 % of the healthy loops and of those with a disturbance alone, together
  /// In worlds `at_05` of kRedraws samples of the calibration worlds, with replacement, in ascending order:
  /// what other calibration loops would have made of it. Infinite where a sample has too few loops; empty
  /// without worlds, or without `at_05`.
  std::vector<double> redrawn_05 = {};

  /// How many of `redrawn_05` the score exceeds.
  int redraws_exceeded_by(double score) const;
};

/// Those of the method in place `method`; all without a value when there are no loops. The study must have a
/// calibration.
CalibratedThresholds calibrated_thresholds(const Study& study, const Calibration& calibration,
                                           std::size_t method);

}  // namespace mpm
