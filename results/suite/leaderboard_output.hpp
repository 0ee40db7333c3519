#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/findings/leaderboard_standing.hpp"
#include "results/document/document.hpp"
#include "results/plot/figure.hpp"

namespace mpm {

/// Width of the leaderboard in a terminal, in columns.
inline constexpr std::size_t kLeaderboardWidth = 120;

/// Makes the leaderboard for people: one table per score, with a row for each method and a column for each
/// family.
Document leaderboard_document(const Leaderboard& board);

/// Returns the leaderboard as JSON (docs/suite.md), with all rates, by family and by plant.
std::string leaderboard_json(const Leaderboard& board);

/// Draws the columns of the table as dots with whiskers, one row per method.
Figure leaderboard_figure(const Leaderboard& board);

/// Returns the name of a method as people read it: "reference" for kReferenceMethod.
std::string label_of(const std::string& method);
/// Returns it as words for the head of a row; own methods are marked.
std::string row_name(const Leaderboard& board, std::size_t method);

/// Says where a method stands: "mine is number 3 of 11 ...".
std::string standing_sentence(const Leaderboard& board, std::size_t method,
                              const std::optional<Standing>& standing);

/// Shows the best method for each question, the place of the user's own methods, and the table of
/// board_columns.hpp.
Section standing_section(const Leaderboard& board);

/// Returns one rate for each question that a method may answer, at the threshold for 5 % false alarms.
std::vector<std::string_view> question_rates();

/// Shows one column per question, over the loops that ask it, with ranks among the methods that answer it.
/// The section is empty if the suite has no worlds.
Section questions_section(const Leaderboard& board);

/// Returns the names of the estimates that score stated probabilities.
std::vector<std::string_view> probability_scores();

/// Returns the methods that state probabilities, by their logarithmic score, the best first.
std::vector<std::size_t> stating_methods(const Leaderboard& board);

/// Show the scores of stated probabilities against the frequencies of the suite, with reliability diagrams,
/// and the same by family. Both are empty if no method states probabilities.
Section probabilities_section(const Leaderboard& board);
Section probabilities_by_family_section(const Leaderboard& board);

/// Shows a table of confusions for each method. The section is empty if the board does not store the answers.
Section confusions_section(const Leaderboard& board);

/// Returns "~" if a method gives verdicts only on part of the loops, otherwise "". Each of its numbers has
/// it.
const char* part_mark(const PooledScores& scores);

/// Returns the rates that the correction by the benchmark may change.
std::vector<std::string_view> information_rates();

/// Shows the effect of the correction by the benchmark on each method that the board has with and without it,
/// and the gain from the choice of the method. The section is empty if there is no such method.
Section information_section(const Leaderboard& board);

}  // namespace mpm
