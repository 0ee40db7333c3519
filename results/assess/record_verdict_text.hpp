#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

// Puts the verdict on a record into words. Nothing is decided here.

namespace mpm {

/// One answer per question.
struct RecordVerdictText {
  std::string model, loop, action;
  std::string benchmark;  ///< which period counts as the plant's habit, or could count
  /// The reasons: one sentence for each score of the model, each cost, and the probabilities, with their
  /// thresholds.
  std::vector<std::string> scores, costs;
  std::string probabilities;  ///< empty: not known
};

/// Returns the texts of a verdict. `stamps` are those of the samples. Names are those of the study, not
/// escaped.
RecordVerdictText record_verdict_text(const RecordVerdict& verdict, const Study& study,
                                      const std::vector<std::string>& stamps);

/// Formats two numbers with the same number of digits: at least three, and enough to tell them apart: "9.37",
/// "1.22".
std::pair<std::string, std::string> told_apart(double a, double b);

/// Rounds probabilities to tenths of a percent, each at least 1, that add up to 1000.
std::array<int, kRecordSources> permille(const OfSources& probabilities);

/// Returns words for a source: "a mismatch of the model", "a valve that sticks".
std::string source_text(RecordSource source);

/// Describes a mismatch: "the gain of y2/u1 in the plant is 0.62 (0.55 to 0.7) times that of the model".
std::string mismatch_sentence(const Study& study, const NamedMismatch& named);

}  // namespace mpm
