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

/// 'D', 'L', 'S'
char letter_of(LeaderboardTask task);

/// "48 cells (7 plants, 8 families), 9600 experiments, seed 2026"
std::string size_text(const Leaderboard& board);

/// The families that no method passes.
std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task);

}  // namespace mpm
