#pragma once

#include <string>
#include <vector>

#include "analysis/findings/leaderboard.hpp"

// What text and page of a leaderboard say in the same words.

namespace mpm {

/// '*' for too many false alarms, '~' for verdicts on a part of the loops; empty for neither.
std::string marks_of(const PooledScores& scores);
/// What the marks mean, and what is passed: a sentence each.
std::vector<std::string> legend_sentences(const Leaderboard& board);

/// What a method is called where people read it: "reference" for kReferenceMethod.
std::string label_of(const std::string& method);

/// 'D', 'L', 'S'
char letter_of(LeaderboardTask task);

/// "48 cells (7 plants, 8 families), 9600 experiments, seed 2026"
std::string size_text(const Leaderboard& board);

/// The cells of a family in which methods watched moving windows, in the order of the plants; empty where
/// none did.
std::vector<const CellScores*> monitored_cells(const Leaderboard& board, std::size_t family);

/// "column (min)": the plant of a cell, and the unit of its delays.
std::string plant_and_unit(const Leaderboard& board, const CellScores& cell);

/// What the numbers of delay_words() are.
inline constexpr const char* kDelayTitle =
    "median time from the onset to the end of the first flagged window, faults with an impact; false alarms "
    "a "
    "day";

/// "94 (76 to 103); 0": the median delay of a method with its interval, and its false alarms a day; "-"
/// without a verdict on a window.
std::string delay_words(const MethodScores& scores);

/// The families that no method passes.
std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task);

}  // namespace mpm
