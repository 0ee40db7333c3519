#pragma once

#include <optional>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/findings/calibration.hpp"
#include "analysis/findings/world_counts.hpp"

// What the rates of a leaderboard ask of a loop, and of what a method said of it: few enough facts for one
// letter each, so that finished results can be kept, counted again, and held against those of another method
// loop by loop.

namespace mpm {

struct MethodRates;

/// What is true of a loop.
struct FaultTruth {
  ExperimentKind kind = ExperimentKind::healthy;
  bool impact = false;  ///< has_impact() of its fault
  bool one_cv = false;  ///< its fault affects one CV

  bool faulty() const { return !is_faultless(kind); }
  bool operator==(const FaultTruth&) const = default;
};

/// What a method said of a loop.
struct LoopOutcome {
  bool answered = false;
  bool flagged = false;
  bool above_05 = false;      ///< its score exceeds the threshold calibrated for 5 % false alarms
  bool above_chosen = false;  ///< that for calibration.false_alarms
  bool right_cv = false;      ///< the CV with the largest score is the one that the fault affects
  bool right_source = false;  ///< names_source() of the source that it would name if it flagged the loop
};

FaultTruth truth_of(const Study& study, const ExperimentRecord& record);
LoopOutcome outcome_of(const ExperimentRecord& record, const AssessmentRecord& said,
                       const CalibratedThresholds& thresholds);

/// In place of a letter: a loop that did not run to its end, which no method has looked at.
inline constexpr char kNoLoop = '-';

/// A letter of base64 (RFC 4648), whose bits from the lowest are: kind (3 bits, ExperimentKind), impact,
/// one_cv.
char letter_of(const FaultTruth& truth);
/// The members in their order, from the lowest bit.
char letter_of(const LoopOutcome& outcome);
/// None for a character that no truth has.
std::optional<FaultTruth> fault_truth(char letter);
/// None for a character that no outcome has: what is not answered is nothing else, and a right CV is named of
/// a flagged loop alone.
std::optional<LoopOutcome> loop_outcome(char letter);

/// What decides which rates a method can have.
struct OutcomeScope {
  bool locates_cvs = false;
  bool tells_sources = false;
  bool at_05 = false;      ///< it has the threshold calibrated for 5 %
  bool at_chosen = false;  ///< that for calibration.false_alarms
  bool in_worlds = false;
};

OutcomeScope outcome_scope(const Study& study, const MethodDescription& method,
                           const CalibratedThresholds& thresholds);

/// Counts the rates that outcomes decide.
class OutcomeCounts {
 public:
  void add(const OutcomeScope& scope, int world, const FaultTruth& truth, const LoopOutcome& said);
  /// Puts them in their places; the other rates stay as they are.
  void put(MethodRates& rates, double confidence) const;
  /// Is it one of these rates?
  static bool decide(Rate MethodRates::*rate);

 private:
  struct Place;
  static const Place kPlaces[];

  void add_fault(const OutcomeScope& scope, int world, const FaultTruth& truth, const LoopOutcome& said);

  WorldCount answered_, detected_, detected_mpm_, detected_ud_, detected_impact_, flagged_without_impact_,
      false_alarm_healthy_, false_alarm_tuning_, false_alarm_calibrated_, located_, source_, source_all_,
      power_05_, power_05_impact_, source_05_impact_;
};

}  // namespace mpm
