#include "analysis/findings/loop_outcome.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/method_rates.hpp"

namespace mpm {
namespace {

constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr unsigned kKindBits = 3, kKindMask = (1U << kKindBits) - 1;
constexpr int kLastKind = static_cast<int>(ExperimentKind::other);

char letter(unsigned bits) {
  return kLetters[bits];
}

std::optional<unsigned> bits_of(char each) {
  const std::size_t place = kLetters.find(each);
  return place == std::string_view::npos ? std::nullopt : std::optional(static_cast<unsigned>(place));
}

bool bit(unsigned bits, unsigned place) {
  return (bits >> place & 1U) != 0;
}

unsigned bit_at(bool value, unsigned place) {
  return static_cast<unsigned>(value) << place;
}

}  // namespace

FaultTruth truth_of(const Study& study, const ExperimentRecord& record) {
  const bool faulty = !is_faultless(record.draw.kind);
  return {record.draw.kind, faulty && has_impact(study.diagnosis, record),
          faulty && record.draw.true_cv() >= 0};
}

LoopOutcome outcome_of(const ExperimentRecord& record, const AssessmentRecord& said,
                       const CalibratedThresholds& thresholds) {
  if (!said.answered())
    return {};
  const MethodDescription& method = said.form->method();
  const bool faulty = !is_faultless(record.draw.kind);
  return {.answered = true,
          .flagged = said.flagged,
          .above_05 = thresholds.at_05.exceeded_by(said.score),
          .above_chosen = thresholds.chosen.exceeded_by(said.score),
          .right_cv = faulty && said.flagged && method.locates_cvs && record.draw.true_cv() >= 0 &&
                      said.predicted_cv == record.draw.true_cv(),
          .right_source = faulty && method.tells_sources && names_source(record, said.predicted_source)};
}

char letter_of(const FaultTruth& truth) {
  return letter(static_cast<unsigned>(truth.kind) | bit_at(truth.impact, kKindBits) |
                bit_at(truth.one_cv, kKindBits + 1));
}

char letter_of(const LoopOutcome& outcome) {
  return letter(bit_at(outcome.answered, 0) | bit_at(outcome.flagged, 1) | bit_at(outcome.above_05, 2) |
                bit_at(outcome.above_chosen, 3) | bit_at(outcome.right_cv, 4) |
                bit_at(outcome.right_source, 5));
}

std::optional<FaultTruth> fault_truth(char letter) {
  const std::optional<unsigned> bits = bits_of(letter);
  if (!bits || (*bits & kKindMask) > kLastKind || *bits >> (kKindBits + 2) != 0)
    return std::nullopt;
  const FaultTruth truth{static_cast<ExperimentKind>(*bits & kKindMask), bit(*bits, kKindBits),
                         bit(*bits, kKindBits + 1)};
  return truth.faulty() || (!truth.impact && !truth.one_cv) ? std::optional(truth) : std::nullopt;
}

std::optional<LoopOutcome> loop_outcome(char letter) {
  const std::optional<unsigned> bits = bits_of(letter);
  if (!bits)
    return std::nullopt;
  const LoopOutcome outcome{bit(*bits, 0), bit(*bits, 1), bit(*bits, 2),
                            bit(*bits, 3), bit(*bits, 4), bit(*bits, 5)};
  const bool possible = outcome.answered ? outcome.flagged || !outcome.right_cv : *bits == 0;
  return possible ? std::optional(outcome) : std::nullopt;
}

OutcomeScope outcome_scope(const Study& study, const MethodDescription& method,
                           const CalibratedThresholds& thresholds) {
  return {method.locates_cvs, method.tells_sources, thresholds.at_05.value.has_value(),
          thresholds.chosen.value.has_value(), study.world.has_value()};
}

void OutcomeCounts::add(const OutcomeScope& scope, int world, const FaultTruth& truth,
                        const LoopOutcome& said) {
  answered_.add(world, said.answered);
  if (truth.faulty() && scope.tells_sources) {
    source_all_.add(world, said.flagged && said.right_source);
    if (scope.in_worlds && scope.at_05 && truth.impact)
      source_05_impact_.add(world, said.above_05 && said.right_source);
  }
  if (!said.answered)
    return;
  if (truth.faulty())
    add_fault(scope, world, truth, said);
  else if (truth.kind == ExperimentKind::tuning)
    false_alarm_tuning_.add(world, said.flagged);
  else {
    false_alarm_healthy_.add(world, said.flagged);
    if (scope.at_chosen)
      false_alarm_calibrated_.add(world, said.above_chosen);
  }
}

void OutcomeCounts::add_fault(const OutcomeScope& scope, int world, const FaultTruth& truth,
                              const LoopOutcome& said) {
  const bool mpm = truth.kind == ExperimentKind::mpm, ud = truth.kind == ExperimentKind::ud;
  detected_.add(world, said.flagged);
  (truth.impact ? detected_impact_ : flagged_without_impact_).add(world, said.flagged);
  if (mpm)
    detected_mpm_.add(world, said.flagged);
  if (ud)
    detected_ud_.add(world, said.flagged);
  if (scope.at_05) {
    power_05_.add(world, said.above_05);
    if (truth.impact)
      power_05_impact_.add(world, said.above_05);
  }
  if (!said.flagged)
    return;
  if (scope.locates_cvs && truth.one_cv)
    located_.add(world, said.right_cv);
  if (scope.tells_sources && (mpm || ud))
    source_.add(world, said.right_source);
}

/// Every count once, with the rate that it makes.
struct OutcomeCounts::Place {
  Rate MethodRates::*rate;
  WorldCount OutcomeCounts::*count;
};

constexpr OutcomeCounts::Place OutcomeCounts::kPlaces[] = {
    {&MethodRates::answered, &OutcomeCounts::answered_},
    {&MethodRates::detected, &OutcomeCounts::detected_},
    {&MethodRates::detected_mpm, &OutcomeCounts::detected_mpm_},
    {&MethodRates::detected_ud, &OutcomeCounts::detected_ud_},
    {&MethodRates::detected_impact, &OutcomeCounts::detected_impact_},
    {&MethodRates::flagged_without_impact, &OutcomeCounts::flagged_without_impact_},
    {&MethodRates::false_alarm_healthy, &OutcomeCounts::false_alarm_healthy_},
    {&MethodRates::false_alarm_tuning, &OutcomeCounts::false_alarm_tuning_},
    {&MethodRates::false_alarm_calibrated, &OutcomeCounts::false_alarm_calibrated_},
    {&MethodRates::located, &OutcomeCounts::located_},
    {&MethodRates::source, &OutcomeCounts::source_},
    {&MethodRates::source_all, &OutcomeCounts::source_all_},
    {&MethodRates::power_05, &OutcomeCounts::power_05_},
    {&MethodRates::power_05_impact, &OutcomeCounts::power_05_impact_},
    {&MethodRates::source_05_impact, &OutcomeCounts::source_05_impact_},
};

void OutcomeCounts::put(MethodRates& rates, double confidence) const {
  for (const Place& place : kPlaces)
    rates.*place.rate = (this->*place.count).rate(confidence);
}

bool OutcomeCounts::decide(Rate MethodRates::*rate) {
  return std::any_of(std::begin(kPlaces), std::end(kPlaces),
                     [rate](const Place& place) { return place.rate == rate; });
}

}  // namespace mpm
