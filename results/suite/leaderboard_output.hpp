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

/// Columns of a terminal that the leaderboard takes.
inline constexpr std::size_t kLeaderboardWidth = 120;

/// The leaderboard for people: a table a score, methods down and families across.
Document leaderboard_document(const Leaderboard& board);

/// The same as JSON (docs/suite.md), with all rates, by family and by plant.
std::string leaderboard_json(const Leaderboard& board);

/// The columns of the table as dots with whiskers, a row a method.
Figure leaderboard_figure(const Leaderboard& board);

/// The name of a method as people read it: "reference" for kReferenceMethod.
std::string label_of(const std::string& method);
/// The same as words for the head of a row; one's own methods are marked.
std::string row_name(const Leaderboard& board, std::size_t method);

/// "mine is number 3 of 11 ...": where a method stands, in words.
std::string standing_sentence(const Leaderboard& board, std::size_t method,
                              const std::optional<Standing>& standing);

/// The best method for each question, the place of your own methods, and the table of board_columns.hpp.
Section standing_section(const Leaderboard& board);

/// The questions that a method may answer, a rate each: those at the threshold for 5 % false alarms.
std::vector<std::string_view> question_rates();

/// A column a question, over the loops that ask it, with ranks among the methods that answer it; no content
/// outside of worlds.
Section questions_section(const Leaderboard& board);

/// The scores of stated probabilities, estimates of a method.
std::vector<std::string_view> probability_scores();

/// The methods that state probabilities, by their logarithmic score, the best first.
std::vector<std::size_t> stating_methods(const Leaderboard& board);

/// The scores of stated probabilities against the frequencies of the suite, with reliability diagrams, and
/// the same by family; no content where nobody states any.
Section probabilities_section(const Leaderboard& board);
Section probabilities_by_family_section(const Leaderboard& board);

/// A table of confusions a method; no content of boards that do not keep what was answered.
Section confusions_section(const Leaderboard& board);

/// "~" for a method that gives verdicts on a part of the loops; otherwise empty. It stands at each number.
const char* part_mark(const PooledScores& scores);

/// The rates that the correction by the benchmark may change.
std::vector<std::string_view> information_rates();

/// Effect of the correction by the benchmark to each method that the board has with and without it, and
/// the gain by the choice of the method; no content without such a method.
Section information_section(const Leaderboard& board);

}  // namespace mpm
