#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

// The verdict on a record in words. Nothing is decided here.

namespace mpm {

/// An answer a question.
struct RecordVerdictText {
  std::string model, loop, action;
  std::string benchmark;  ///< which period counts as the plant's habit, or could
  /// Why: a sentence each for the scores of the model, the costs, and the probabilities, with their
  /// thresholds.
  std::vector<std::string> scores, costs;
  std::string probabilities;  ///< empty: not known
};

/// `stamps` of the samples. Foreign names are as in the study.
RecordVerdictText record_verdict_text(const RecordVerdict& verdict, const Study& study,
                                      const std::vector<std::string>& stamps);

/// Two numbers with as many digits, three or more, as tell them apart: "9.37", "1.22".
std::pair<std::string, std::string> told_apart(double a, double b);

/// Tenths of a percent, 1 or more each, that add up to 1000.
std::array<int, kRecordSources> permille(const OfSources& probabilities);

/// "a mismatch of the model", "the valve of R sticks": what a source is.
std::string source_text(RecordSource source);

/// "the gain of y2/u1 in the plant is 0.62 (0.55 to 0.7) times that of the model"
std::string mismatch_sentence(const Study& study, const NamedMismatch& named);

}  // namespace mpm
