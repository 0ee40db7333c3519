#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/leaderboard.hpp"
#include "results/document/document.hpp"

// The table of a leaderboard: a method a row, with the few numbers by which one chooses a method. The page,
// the figure, CSV and LaTeX show this one.

namespace mpm {

/// A column: a rate or an estimate over all loops of the suite.
struct BoardColumn {
  std::string_view name;  ///< in method_numbers()
  /// "naming the source of a fault": at what the method with the most is best; empty: nothing
  std::string_view task = {};
  std::string_view unless = {};  ///< there is the column of this name
};

/// Those for which the board has numbers.
std::vector<BoardColumn> board_columns(const Leaderboard& board);

/// The value of a method, with its interval and the number of loops; NaN where there is none.
Number board_number(const Leaderboard& board, std::size_t method, const BoardColumn& column);

/// The methods but the reference, in the order in which people read them: by rank in worlds, otherwise by the
/// first column.
std::vector<std::size_t> board_order(const Leaderboard& board);

/// A line a method: "method", "own", "answers_in_part", and of each column NAME, NAME_lower, NAME_upper and
/// NAME_loops, as shares.
std::string leaderboard_csv(const Leaderboard& board);

/// A `tabular` with the rules of booktabs, in percent, own methods in bold.
std::string leaderboard_latex(const Leaderboard& board);

}  // namespace mpm
