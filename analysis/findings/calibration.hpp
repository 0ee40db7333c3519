#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/record_range.hpp"

// Thresholds that give every method the same rate of false alarms, so that methods can be compared by what
// they detect at that rate. They are computed from the scores of loops that are drawn with another seed than
// the loops of the study.

namespace mpm {

/// What the methods of a study say about one calibration loop.
struct CalibrationLoop {
  ExperimentKind kind;  ///< healthy, or ud
  /// One score per method, in the order of the methods; NaN: no verdict, -infinity: a verdict without a
  /// score.
  std::vector<double> scores;
};

/// The calibration loops of a study, in the order of their index (scenarios/loop/calibration.hpp).
struct Calibration {
  std::uint64_t seed = 0;
  std::vector<CalibrationLoop> loops;
};

/// The entry of CalibrationLoop::scores for one answer.
double calibration_score(const AssessmentRecord& said);

/// Collects the scores of `records`, the experiments of `loops`, which is a calibration_study().
Calibration calibration_of(const Study& loops, const RecordRange& records);

/// A threshold on the score of a method: loops above it are flagged.
struct CalibratedThreshold {
  std::optional<double> value;  ///< conformal_threshold(); none: too few loops
  std::int64_t loops = 0;       ///< number of loops with a verdict from which it is computed

  bool exceeded_by(double score) const { return value && score > *value; }
};

/// How many times a threshold is redrawn: the largest count that fits the 6 bits of LoopOutcome::redrawn_05
/// in outcome_facts().
inline constexpr int kRedraws = 63;

/// The calibrated thresholds of one method.
struct CalibratedThresholds {
  CalibratedThreshold at_01;    ///< at most 1 % of the healthy loops are flagged
  CalibratedThreshold at_05;    ///< at most 5 % of the healthy loops
  CalibratedThreshold chosen;   ///< at most the share calibration.false_alarms of the study
  CalibratedThreshold not_mpm;  ///< at most 5 % of the loops that are healthy or have a disturbance alone
  /// In a study of worlds: `at_05` recomputed from kRedraws samples of the calibration worlds, drawn with
  /// replacement, in ascending order. They show how `at_05` would vary with other calibration loops. Infinite
  /// if a sample has too few loops; empty without worlds, or without `at_05`.
  std::vector<double> redrawn_05 = {};

  /// How many of `redrawn_05` the score exceeds.
  int redraws_exceeded_by(double score) const;
};

/// Returns the calibrated thresholds of the method at place `method`. Without loops, none of them has a
/// value. The study must have a calibration.
CalibratedThresholds calibrated_thresholds(const Study& study, const Calibration& calibration,
                                           std::size_t method);

}  // namespace mpm
