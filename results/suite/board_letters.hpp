#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/findings/loop_outcome.hpp"

// The loops of a board in its file: a letter of base64 (RFC 4648) for each, of six bits.

namespace mpm {

/// In place of a letter: a loop that did not run to its end, which no method has looked at.
inline constexpr char kNoLoop = '-';

/// The bits of a truth from the lowest: kind (3 bits, ExperimentKind), impact, one_cv.
std::string truth_letters(const LoopTruths& truths);
/// None for a character that no truth has.
std::optional<FaultTruth> fault_truth(char letter);

/// What a method said, in as many texts as its facts need: outcome_facts() from the lowest bit of the first
/// letter on, none of them in two letters.
std::vector<std::string> outcome_letters(const LoopOutcomes& outcomes);
/// The facts of one loop, from its letter in each text; texts that are missing have no bit set. None for
/// characters that no outcome has.
std::optional<LoopOutcome> loop_outcome(const std::string& letters);
/// How many texts there are.
std::size_t outcome_text_count();

}  // namespace mpm
