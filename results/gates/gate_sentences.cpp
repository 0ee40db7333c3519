#include "results/gates/gate_sentences.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/files/utf8.hpp"

namespace mpm {
namespace {

/// Formats a number with the digits that people compare: a tenth of a percent for shares, otherwise four
/// digits.
std::string number_text(double value, bool share) {
  return share ? fmt::format("{:.1f}", 100.0 * value) : fmt::format("{:.4g}", value);
}

std::string percent_sign(bool share) {
  return share ? " %" : "";
}

std::string judged_text(const GateResult& result, double confidence) {
  return result.gate.with_confidence
             ? fmt::format("the {:g} % interval, {},", 100.0 * confidence, interval_text(result))
             : fmt::format("the value, {},", measured_text(result));
}

std::string distance_text(const GateResult& result) {
  return margin_text(result).substr(1);  // without the sign
}

std::string outcome_sentence(const GateResult& result, double confidence) {
  const std::string judged = judged_text(result, confidence);
  const std::string limit = limit_text(result);
  switch (result.doubt) {
    case GateDoubt::no_value:
      return "nothing was measured";
    case GateDoubt::too_few:
      return fmt::format("{} experiments or pairs behind the number, and the gate asks for {}",
                         result.measured.count, result.gate.minimum_count);
    case GateDoubt::no_interval:
      return fmt::format("too few experiments or pairs for an interval ({})", result.measured.count);
    case GateDoubt::straddles:
      return fmt::format("{} lies only partly within {}: one end is {} beyond it", judged, limit,
                         distance_text(result));
    case GateDoubt::none:
      break;
  }
  return result.outcome == GateOutcome::pass
             ? fmt::format("{} keeps to {} with {} to spare", judged, limit, distance_text(result))
             : fmt::format("{} misses {} by {}", judged, limit, distance_text(result));
}

}  // namespace

std::string limit_text(const GateResult& result) {
  const Gate& gate = result.gate;
  const bool share = result.measured.is_share();
  const std::string unit = percent_sign(share);
  if (std::isinf(gate.maximum))
    return fmt::format(">= {}{}", number_text(gate.minimum, share), unit);
  if (std::isinf(gate.minimum))
    return fmt::format("<= {}{}", number_text(gate.maximum, share), unit);
  return fmt::format("{} to {}{}", number_text(gate.minimum, share), number_text(gate.maximum, share), unit);
}

std::string measured_text(const GateResult& result) {
  const bool share = result.measured.is_share();
  if (std::isnan(result.measured.value))
    return "-";
  return number_text(result.measured.value, share) + percent_sign(share);
}

std::string interval_text(const GateResult& result) {
  const bool share = result.measured.is_share();
  const Interval& interval = result.measured.interval;
  if (std::isnan(interval.lower) || std::isnan(interval.upper))
    return "-";
  return fmt::format("{} to {}{}", number_text(interval.lower, share), number_text(interval.upper, share),
                     percent_sign(share));
}

std::string margin_text(const GateResult& result) {
  if (std::isnan(result.margin))
    return "-";
  return result.measured.is_share() ? fmt::format("{:+.1f} pp", 100.0 * result.margin)
                                    : fmt::format("{:+.3g}", result.margin);
}

std::string explanation(const GateResult& result, double confidence) {
  const std::string reason =
      result.gate.reason.empty() ? "" : fmt::format(" ({})", plain_text(result.gate.reason));
  return fmt::format("{}: {}: {}{}", result.gate.name, to_string(result.outcome),
                     outcome_sentence(result, confidence), reason);
}

std::string verdict_sentence(const GateCheck& check) {
  const auto count = [&](GateOutcome outcome) {
    return std::count_if(check.results.begin(), check.results.end(),
                         [outcome](const GateResult& result) { return result.outcome == outcome; });
  };
  const auto inconclusive = count(GateOutcome::inconclusive);
  const char* counts_as =
      check.inconclusive == InconclusivePolicy::fail ? "fails the check" : "is let through";
  return fmt::format("{}: {} of {} gates pass, {} fail, {} inconclusive{}",
                     check.passed() ? "PASSED" : "FAILED", count(GateOutcome::pass), check.results.size(),
                     count(GateOutcome::fail), inconclusive,
                     inconclusive > 0 ? fmt::format(", which {}", counts_as) : "");
}

std::string difference_text(const StudyDifference& difference) {
  const auto value = [](const std::string& of) { return of.empty() ? "not there" : of; };
  return fmt::format("{} -> {}", value(difference.before), value(difference.now));
}

std::string changes_text(const JudgementChanges& changes) {
  std::string text;
  for (const auto* list : {&changes.lost, &changes.gained})
    for (const JudgementPair& pair : *list)
      text +=
          fmt::format("  {:>5}  {:<6}  {} -> {}{}{}\n", pair.index, list == &changes.lost ? "lost" : "gained",
                      to_string(pair.before), to_string(pair.now), pair.cell.empty() ? "" : "  ", pair.cell);
  return text;
}

std::string details_text(const GateCheck& check, const GateResult& result) {
  if (!check.baseline || result.outcome == GateOutcome::pass)
    return "";
  const BaselineChanges* const changes = check.baseline->of(result);
  return changes == nullptr ? "" : changes_text(changes->changes);
}

}  // namespace mpm
