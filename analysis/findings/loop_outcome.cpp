#include "analysis/findings/loop_outcome.hpp"

namespace mpm {
namespace {

template <bool LoopOutcome::*member>
constexpr OutcomeFact yes_or_no() {
  return {1, [](const LoopOutcome& said) { return static_cast<unsigned>(said.*member); },
          [](LoopOutcome& said, unsigned number) { said.*member = number != 0; }};
}

template <Correctness LoopOutcome::*member>
constexpr OutcomeFact verdict() {
  return {2, [](const LoopOutcome& said) { return static_cast<unsigned>(said.*member); },
          [](LoopOutcome& said, unsigned number) {
            said.*member = number > 2 ? Correctness::not_judged : static_cast<Correctness>(number);
          }};
}

bool judged_rightly(Correctness verdict) {
  return verdict == Correctness::right;
}

bool judged(Correctness verdict) {
  return verdict != Correctness::not_judged;
}

}  // namespace

std::vector<OutcomeFact> outcome_facts() {
  return {
      yes_or_no<&LoopOutcome::answered>(),
      yes_or_no<&LoopOutcome::flagged>(),
      yes_or_no<&LoopOutcome::above_05>(),
      yes_or_no<&LoopOutcome::above_chosen>(),
      yes_or_no<&LoopOutcome::right_cv>(),
      yes_or_no<&LoopOutcome::right_source>(),
      yes_or_no<&LoopOutcome::above_01>(),
      yes_or_no<&LoopOutcome::above_not_mpm>(),
      yes_or_no<&LoopOutcome::names_source>(),
      verdict<&LoopOutcome::channel>(),
      verdict<&LoopOutcome::parameter>(),
      verdict<&LoopOutcome::size>(),
      verdict<&LoopOutcome::candidate>(),
      verdict<&LoopOutcome::window>(),
      verdict<&LoopOutcome::mismatch>(),
      {6, [](const LoopOutcome& said) { return unsigned{said.redrawn_05}; },
       [](LoopOutcome& said, unsigned number) { said.redrawn_05 = static_cast<std::uint8_t>(number); }},
      {3, [](const LoopOutcome& said) { return static_cast<unsigned>(said.told); },
       [](LoopOutcome& said, unsigned number) { said.told = static_cast<ToldSource>(number); }},
  };
}

FaultTruth truth_of(const Study& study, const ExperimentRecord& record) {
  const bool faulty = !is_faultless(record.draw.kind);
  return {record.draw.kind, faulty && has_impact(study.diagnosis, record),
          faulty && record.draw.true_cv() >= 0,
          record.draw.other ? told_source(*record.draw.other) : ToldSource::other};
}

OutcomeScope outcome_scope(const Study& study, const MethodDescription& method,
                           const CalibratedThresholds& thresholds) {
  return {.locates_cvs = method.locates_cvs,
          .tells_sources = method.tells_sources,
          .at_05 = thresholds.at_05.value.has_value(),
          .at_chosen = thresholds.chosen.value.has_value(),
          .in_worlds = study.world.has_value(),
          .at_01 = thresholds.at_01.value.has_value(),
          .at_not_mpm = thresholds.not_mpm.value.has_value(),
          .chosen_is_05 = study.calibration && study.calibration->false_alarms == 0.05,
          .is_whole = true,
          .is_told = true};
}

namespace {

/// Whether the source that it tells is one that a method of this scope can tell, and agrees with the facts
/// `names_source` and `right_source`.
bool is_told_rightly(const LoopOutcome& said, const FaultTruth& truth, const OutcomeScope& scope) {
  const FaultSource told = source_of(said.told);
  if (!scope.is_told || !scope.tells_sources)
    return told == FaultSource::none;
  return said.names_source == (said.flagged && told != FaultSource::none) &&
         said.right_source == (truth.faulty() && names_source(truth.kind, told));
}

}  // namespace

bool is_possible(const LoopOutcome& said, const FaultTruth& truth, const OutcomeScope& scope) {
  if (!said.answered)
    return said == LoopOutcome{};
  const bool above = (!said.above_05 || scope.at_05) && (!said.above_chosen || scope.at_chosen) &&
                     (!said.above_01 || scope.at_01) && (!said.above_not_mpm || scope.at_not_mpm);
  const bool named = (!said.right_cv || (said.flagged && truth.one_cv && scope.locates_cvs)) &&
                     (!said.right_source || (truth.faulty() && scope.tells_sources)) &&
                     (!said.names_source || (said.flagged && scope.tells_sources));
  const bool asked = truth.faulty() || (!judged(said.channel) && !judged(said.parameter) &&
                                        !judged(said.candidate) && !judged(said.window));
  const bool right = said.flagged || (!judged_rightly(said.channel) && !judged_rightly(said.parameter) &&
                                      !judged(said.candidate));
  const bool redrawn = said.redrawn_05 == 0 || (scope.at_05 && scope.in_worlds);
  const bool of_model = (truth.has_mismatch() || truth.kind == ExperimentKind::ud) && scope.tells_sources;
  return above && redrawn && named && is_told_rightly(said, truth, scope) &&
         judged(said.mismatch) <= of_model && asked && right &&
         judged(said.size) <= judged_rightly(said.parameter) && judged(said.window) <= truth.impact;
}

}  // namespace mpm
