#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/findings/loop_outcome.hpp"

// How the file of a board stores loops: a letter of base64 (RFC 4648), which has six bits, for each loop.

namespace mpm {

/// Replaces the letter of a loop that did not run to its end, so that no method has seen it.
inline constexpr char kNoLoop = '-';

/// Writes the truths as letters. The bits from the lowest: kind (3 bits, ExperimentKind), impact, one_cv.
std::string truth_letters(const LoopTruths& truths);
/// Reads a truth; none if the letter is no truth.
std::optional<FaultTruth> fault_truth(char letter);

/// Writes what a method said, in as many texts as its facts need. The facts are outcome_facts(), from the
/// lowest bit of the first letter on; no fact is split between two letters.
std::vector<std::string> outcome_letters(const LoopOutcomes& outcomes);
/// Reads the facts of one loop from its letter in each text. In a text that is missing, no bit is set. None
/// if the letters are no outcome.
std::optional<LoopOutcome> loop_outcome(const std::string& letters);
/// Returns how many texts an outcome needs.
std::size_t outcome_text_count();

}  // namespace mpm
