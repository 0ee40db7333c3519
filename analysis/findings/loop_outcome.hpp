#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/calibration.hpp"
#include "scenarios/faults/told_source.hpp"

// The facts about a loop, and about the answer of a method, from which rates are computed. They are so few
// that finished results can be kept, counted again, and compared with those of another method loop by loop.

namespace mpm {

/// The truth about a loop.
struct FaultTruth {
  ExperimentKind kind = ExperimentKind::healthy;
  bool impact = false;                   ///< has_impact() of its fault
  bool one_cv = false;                   ///< its fault affects one CV
  ToldSource about = ToldSource::other;  ///< for the kind `other`: the place of its fault

  bool faulty() const { return !is_faultless(kind); }
  ToldSource source() const { return told_source(source_of(kind), about); }
  bool has_mismatch() const { return kind == ExperimentKind::mpm || kind == ExperimentKind::mpm_ud; }
  bool operator==(const FaultTruth&) const = default;
};

/// What a method said about a loop. A new fact needs a member here, a row in outcome_facts(), and a value in
/// SeenLoop::outcome() (method_rates.cpp).
struct LoopOutcome {
  bool answered = false;
  bool flagged = false;
  bool above_05 = false;       ///< its score exceeds the threshold calibrated for 5 % false alarms
  bool above_chosen = false;   ///< its score exceeds the threshold calibrated for calibration.false_alarms
  bool right_cv = false;       ///< the CV with the largest score is the one that the fault affects
  bool right_source = false;   ///< names_source() of the source that it would name if it flagged the loop
  bool above_01 = false;       ///< its score exceeds the threshold calibrated for 1 % false alarms
  bool above_not_mpm = false;  ///< its score exceeds the threshold for 5 % among loops without a mismatch
  bool names_source = false;   ///< named_source() is a source
  Correctness channel = {};    ///< as in Judgement, and so are the next three
  Correctness parameter = {};
  Correctness size = {};
  Correctness candidate = {};
  Correctness window = {};  ///< a window that ends after the onset of a fault with an impact is flagged
  /// Whether the source that it would name if it flagged the loop includes a mismatch if the fault does, and
  /// does not if the fault is a disturbance alone.
  Correctness mismatch = {};
  /// CalibratedThresholds::redraws_exceeded_by() of its score: shows what `above_05` would be under other
  /// thresholds.
  std::uint8_t redrawn_05 = 0;
  /// The source that it would name if it flagged the loop; none for a method that tells no sources.
  ToldSource told = ToldSource::none;

  bool operator==(const LoopOutcome&) const = default;
};

/// A member of LoopOutcome as a whole number.
struct OutcomeFact {
  unsigned bits;  ///< that the number needs
  unsigned (*get)(const LoopOutcome&);
  void (*set)(LoopOutcome&, unsigned);  ///< a number that the member cannot have becomes 0
};

/// Returns every member once. Files store them in this order, so a new fact goes to the end.
std::vector<OutcomeFact> outcome_facts();

/// One entry per loop, in the order of the loops; none for a loop that did not run to its end, which no
/// method assessed.
using LoopTruths = std::vector<std::optional<FaultTruth>>;
using LoopOutcomes = std::vector<std::optional<LoopOutcome>>;

/// What decides which rates a method can have.
struct OutcomeScope {
  bool locates_cvs = false;
  bool tells_sources = false;
  bool at_05 = false;      ///< it has the threshold calibrated for 5 %
  bool at_chosen = false;  ///< it has the threshold calibrated for calibration.false_alarms
  bool in_worlds = false;
  bool at_01 = false;         ///< it has the threshold calibrated for 1 %
  bool at_not_mpm = false;    ///< it has the threshold for 5 % among loops without a mismatch
  bool chosen_is_05 = false;  ///< calibration.false_alarms are 5 %
  bool is_whole = false;  ///< all facts before `told` are known; otherwise only those up to `right_source`
  bool is_told = false;   ///< LoopOutcome::told is known
};

FaultTruth truth_of(const Study& study, const ExperimentRecord& record);
OutcomeScope outcome_scope(const Study& study, const MethodDescription& method,
                           const CalibratedThresholds& thresholds);
/// Whether a method of this scope can give this outcome for a loop. A loop without an answer has no other
/// fact, a right CV is named only in a flagged loop, and no fact is right about something that is not in the
/// loop.
bool is_possible(const LoopOutcome& outcome, const FaultTruth& truth, const OutcomeScope& scope);

/// A loop that a method has looked at.
struct JudgedLoop {
  const OutcomeScope& scope;
  const FaultTruth& truth;
  const LoopOutcome& said;
};

}  // namespace mpm
