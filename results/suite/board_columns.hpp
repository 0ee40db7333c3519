#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/leaderboard.hpp"
#include "results/document/document.hpp"

// The table of a leaderboard: one row per method, with the few numbers by which people choose a method. The
// page, the figure, CSV and LaTeX all show this table.

namespace mpm {

/// A column: a rate or an estimate over all loops of the suite.
struct BoardColumn {
  std::string_view name;  ///< name in method_numbers()
  /// What the method with the highest value is best at, such as "naming the source of a fault"; empty:
  /// nothing.
  std::string_view task = {};
  std::string_view unless = {};  ///< this column is left out if the board has one of this name
};

/// Returns the columns for which the board has numbers.
std::vector<BoardColumn> board_columns(const Leaderboard& board);

/// Returns the value of a method, with its interval and the number of loops; NaN if there is none.
Number board_number(const Leaderboard& board, std::size_t method, const BoardColumn& column);

/// Returns the methods except the reference, in reading order: by rank in a suite of worlds, otherwise by the
/// first column.
std::vector<std::size_t> board_order(const Leaderboard& board);

/// Writes one line per method: "method", "own", "answers_in_part", and for each column NAME, NAME_lower,
/// NAME_upper and NAME_loops, as shares.
std::string leaderboard_csv(const Leaderboard& board);

/// Writes a `tabular` with the rules of booktabs, in percent, with own methods in bold.
std::string leaderboard_latex(const Leaderboard& board);

}  // namespace mpm
