#include "analysis/findings/rate_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace mpm {
namespace {

using Kind = ExperimentKind;

constexpr bool is_judged(Correctness verdict) {
  return verdict != Correctness::not_judged;
}
constexpr bool is_right(Correctness verdict) {
  return verdict == Correctness::right;
}

/// Whether the questions at equal false alarms are asked about this loop.
constexpr bool is_asked(const JudgedLoop& l) {
  return l.scope.in_worlds && l.scope.at_05 && l.truth.impact;
}

constexpr std::array<RateRow, 30> kRates{{
    {{"answered", "Verdict given", "share of all loops on which the method gave a verdict"},
     [](const JudgedLoop&) { return true; },
     [](const JudgedLoop& l) { return l.said.answered; }},
    {{"detected", "Faults flagged", "share of the loops with a fault that are flagged"},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.faulty(); },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"detected_mpm", "Mismatches flagged", "share of the loops with a mismatch alone that are flagged"},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.kind == Kind::mpm; },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"detected_ud", "Disturbances flagged", "share of the loops with a disturbance alone that are flagged"},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.kind == Kind::ud; },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"detected_impact", "Impact flagged",
      "share of the loops with a fault that has an impact that are flagged"},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.impact; },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"flagged_without_impact", "No impact, flagged",
      "share of the loops with a fault that has no impact that are flagged", true},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.faulty() && !l.truth.impact; },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"false_alarm_healthy", "Healthy flagged",
      "share of the loops without a fault and with the designed tuning that are flagged", true},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.kind == Kind::healthy; },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"false_alarm_tuning", "Bad tuning flagged",
      "share of the loops without a fault and with bad tuning that are flagged", true},
     [](const JudgedLoop& l) { return l.said.answered && l.truth.kind == Kind::tuning; },
     [](const JudgedLoop& l) { return l.said.flagged; }},
    {{"located", "CV located",
      "share of the flagged loops with a fault on one CV in which this CV has the largest score"},
     [](const JudgedLoop& l) { return l.scope.locates_cvs && l.said.flagged && l.truth.one_cv; },
     [](const JudgedLoop& l) { return l.said.right_cv; }},
    {{"source", "Source, one fault",
      "share of the flagged loops with a mismatch or a disturbance alone in which the located CV has the "
      "right source"},
     [](const JudgedLoop& l) {
       return l.scope.tells_sources && l.said.flagged &&
              (l.truth.kind == Kind::mpm || l.truth.kind == Kind::ud);
     },
     [](const JudgedLoop& l) { return l.said.right_source; }},
    {{"channel", "Channel named",
      "share of the flagged loops with one mismatch of an MV in which its channel is named"},
     [](const JudgedLoop& l) { return l.said.flagged && is_judged(l.said.channel); },
     [](const JudgedLoop& l) { return is_right(l.said.channel); }},
    {{"channel_impact", "Channel named, impact",
      "share of the loops with one mismatch of an MV that has an impact in which the loop is flagged and the "
      "channel is named"},
     [](const JudgedLoop& l) { return l.truth.impact && is_judged(l.said.channel); },
     [](const JudgedLoop& l) { return is_right(l.said.channel); }},
    {{"parameter_impact", "Parameter named, impact",
      "share of the loops with one mismatch of an MV that has an impact in which the loop is flagged and the "
      "method is most certain of the right channel and parameter"},
     [](const JudgedLoop& l) { return l.truth.impact && is_judged(l.said.parameter); },
     [](const JudgedLoop& l) { return is_right(l.said.parameter); }},
    {{"size_covered", "Size in its interval",
      "share of the flagged loops with one mismatch of an MV whose channel and parameter are named in which "
      "the interval of the size holds the true size"},
     [](const JudgedLoop& l) { return is_judged(l.said.size); },
     [](const JudgedLoop& l) { return is_right(l.said.size); }},
    {{"candidate", "Cause named",
      "share of the flagged loops with a disturbance that a logged signal drives in which the method names "
      "this signal",
      false, StudyFeature::candidates},
     [](const JudgedLoop& l) { return is_judged(l.said.candidate); },
     [](const JudgedLoop& l) { return is_right(l.said.candidate); }},
    {{"source_all", "Source, all faults",
      "share of all loops with a fault, with or without verdict, that are flagged with the right source: "
      "mismatch, disturbance or both; for another fault, `other` or none"},
     [](const JudgedLoop& l) { return l.scope.tells_sources && l.truth.faulty(); },
     [](const JudgedLoop& l) { return l.said.flagged && l.said.right_source; }},
    {{"abstained", "No source named",
      "share of all loops with a fault, with or without verdict, in which no source is named", true},
     [](const JudgedLoop& l) { return l.scope.is_whole && l.scope.tells_sources && l.truth.faulty(); },
     [](const JudgedLoop& l) { return !l.said.names_source; }},
    {{"false_alarm_calibrated", "Healthy, calibrated",
      "share of the loops without a fault and with the designed tuning above the threshold calibrated for "
      "the "
      "study's rate of false alarms, calibration.false_alarms",
      true, StudyFeature::calibration},
     [](const JudgedLoop& l) {
       return l.scope.at_chosen && l.said.answered && l.truth.kind == Kind::healthy;
     },
     [](const JudgedLoop& l) { return l.said.above_chosen; }},
    {{"power_01", "Faults flagged at 1 %",
      "share of the loops with a fault above the threshold calibrated for 1 % false alarms", false,
      StudyFeature::calibration},
     [](const JudgedLoop& l) { return l.scope.at_01 && l.said.answered && l.truth.faulty(); },
     [](const JudgedLoop& l) { return l.said.above_01; }},
    {{"power_05", "Faults flagged at 5 %",
      "share of the loops with a fault above the threshold calibrated for 5 % false alarms", false,
      StudyFeature::calibration},
     [](const JudgedLoop& l) { return l.scope.at_05 && l.said.answered && l.truth.faulty(); },
     [](const JudgedLoop& l) { return l.said.above_05; }},
    {{"power_05_impact", "Impact at 5 %",
      "share of the loops with a fault that has an impact above the threshold calibrated for 5 % false "
      "alarms",
      false, StudyFeature::calibration},
     [](const JudgedLoop& l) { return l.scope.at_05 && l.said.answered && l.truth.impact; },
     [](const JudgedLoop& l) { return l.said.above_05; }},
    {{"power_05_mpm", "Mismatch, not disturbance, at 5 %",
      "share of the loops with a mismatch alone above the threshold calibrated for 5 % false alarms among "
      "loops without a fault or with a disturbance alone",
      false, StudyFeature::calibration},
     [](const JudgedLoop& l) { return l.scope.at_not_mpm && l.said.answered && l.truth.kind == Kind::mpm; },
     [](const JudgedLoop& l) { return l.said.above_not_mpm; }},
    {{"source_05_impact", "Source at 5 %",
      "share of all loops with a fault that has an impact, with or without verdict, above the threshold "
      "calibrated for 5 % false alarms and with the right source, as for source_all",
      false, StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) {
       return l.scope.in_worlds && l.scope.at_05 && l.scope.tells_sources && l.truth.impact;
     },
     [](const JudgedLoop& l) { return l.said.above_05 && l.said.right_source; }},
    {{"mismatch_05_impact", "Mismatch or not at 5 %",
      "share of the loops with a mismatch, a disturbance or both that has an impact in which the method is "
      "right about whether there is a mismatch: it says so above the threshold calibrated for 5 % false "
      "alarms, or it does not",
      false, StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) { return is_asked(l) && is_judged(l.said.mismatch); },
     [](const JudgedLoop& l) {
       const bool says_so = l.said.above_05 && is_right(l.said.mismatch) == l.truth.has_mismatch();
       return says_so == l.truth.has_mismatch();
     }},
    {{"source_05_mpm", "Mismatch named at 5 %",
      "share of all loops with a mismatch alone that has an impact, with or without verdict, above the "
      "threshold calibrated for 5 % false alarms and with the right source",
      false, StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) { return is_asked(l) && l.scope.tells_sources && l.truth.kind == Kind::mpm; },
     [](const JudgedLoop& l) { return l.said.above_05 && l.said.right_source; }},
    {{"source_05_ud", "Disturbance named at 5 %",
      "share of all loops with a disturbance alone that has an impact, with or without verdict, above the "
      "threshold calibrated for 5 % false alarms and with the right source",
      false, StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) { return is_asked(l) && l.scope.tells_sources && l.truth.kind == Kind::ud; },
     [](const JudgedLoop& l) { return l.said.above_05 && l.said.right_source; }},
    {{"channel_05_impact", "Channel at 5 %",
      "share of the loops with one mismatch of an MV that has an impact that are flagged, above the "
      "threshold "
      "calibrated for 5 % false alarms, and whose channel is named",
      false, StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) { return is_asked(l) && is_judged(l.said.channel); },
     [](const JudgedLoop& l) { return l.said.above_05 && is_right(l.said.channel); }},
    {{"parameter_05_impact", "Parameter at 5 %",
      "the same, of which the method is most certain of the right channel and parameter", false,
      StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) { return is_asked(l) && is_judged(l.said.parameter); },
     [](const JudgedLoop& l) { return l.said.above_05 && is_right(l.said.parameter); }},
    {{"size_05_impact", "Size at 5 %", "the same, whose interval of the size holds the true size", false,
      StudyFeature::calibrated_worlds},
     [](const JudgedLoop& l) { return is_asked(l) && is_judged(l.said.parameter); },
     [](const JudgedLoop& l) { return l.said.above_05 && is_right(l.said.size); }},
    {{"monitored_impact", "Impact flagged in a window",
      "share of the loops with a fault that has an impact in which a window that ends after the onset is "
      "flagged",
      false, StudyFeature::monitoring},
     [](const JudgedLoop& l) { return is_judged(l.said.window); },
     [](const JudgedLoop& l) { return is_right(l.said.window); }},
}};

}  // namespace

bool has_feature(const Study& study, StudyFeature feature) {
  switch (feature) {
    case StudyFeature::any:
      return true;
    case StudyFeature::candidates:
      return study.record.candidates > 0;
    case StudyFeature::calibration:
      return study.calibration.has_value();
    case StudyFeature::monitoring:
      return study.monitoring.has_value();
    case StudyFeature::worlds:
      return study.world.has_value();
    case StudyFeature::calibrated_worlds:
      return study.world && study.calibration;
  }
  return false;
}

std::span<const RateRow> rate_rows() {
  return kRates;
}

void RedrawnShare::add(bool below, bool above, int exceeded) {
  ++total_;
  below_ += below ? 1 : 0;
  changes_[static_cast<std::size_t>(exceeded)] += static_cast<int>(above) - static_cast<int>(below);
}

double RedrawnShare::variance() const {
  if (total_ == 0)
    return 0.0;
  const auto n = static_cast<double>(total_);
  // A loop that exceeds k of the thresholds in ascending order is above the first k of them.
  std::int64_t hits = below_;
  for (const std::int64_t change : changes_)
    hits += change;
  double sum = 0.0, squares = 0.0;
  for (std::size_t threshold = 0; threshold < kRedraws; ++threshold) {
    hits -= changes_[threshold];
    const double share = static_cast<double>(hits) / n;
    sum += share;
    squares += share * share;
  }
  return std::max(0.0, (squares - sum * sum / kRedraws) / (kRedraws - 1));
}

void RateCounts::add(const JudgedLoop& loop, int world) {
  const bool redraws = loop.scope.in_worlds && loop.scope.at_05 && loop.scope.is_whole;
  LoopOutcome below = loop.said, above = loop.said;
  below.above_05 = false;
  above.above_05 = true;
  if (loop.scope.chosen_is_05) {
    below.above_chosen = false;
    above.above_chosen = true;
  }
  for (const RateRow& row : counts_.rows())
    if (const std::optional<bool> hit = row.ask(loop)) {
      counts_.of(row).add(world, *hit);
      if (redraws)
        redrawn_.of(row).add(row.hit({loop.scope, loop.truth, below}),
                             row.hit({loop.scope, loop.truth, above}), loop.said.redrawn_05);
    }
}

Rates RateCounts::rates(double confidence) const {
  Rates rates(counts_.rows());
  for (const RateRow& row : counts_.rows())
    rates.of(row) = counts_.of(row).rate(confidence, redrawn_.of(row).variance());
  return rates;
}

}  // namespace mpm
