#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "analysis/findings/finished_board.hpp"
#include "analysis/study_files/suite_file.hpp"

// The file SUITE.board.json (docs/suite.md). It has letters for each loop and method. From these the rates of
// a leaderboard are counted again, and a user's own method is paired with the methods in the file.

namespace mpm {

/// "standard.board.json"
std::string board_file_name(const Suite& suite);

/// Returns where the finished board belongs, beside the file of the suite, even if it does not exist.
std::filesystem::path finished_board_path(const Suite& suite);

/// Returns `path` if it is a board file, or the only board file in the folder `path`; none if it is neither.
/// Errors: InputError if the folder has several.
std::optional<std::filesystem::path> find_board(const std::filesystem::path& path);

/// The suite named in a board file, and the seed of the run.
struct BoardHeading {
  std::string suite;
  std::uint64_t seed;
};
/// Reads the heading of a board file. Errors: as read_board().
BoardHeading board_heading(const std::filesystem::path& path);

/// Returns the text of a board file. The cells of `board` must be cells of this suite. Shares of repairs and
/// delays are rounded to four digits.
std::string board_text(const Suite& suite, const Leaderboard& board, const std::string& revision);

/// Reads a board file, which another program may have written, and compares it with the suite: name, version
/// and seed, and the study of each cell. It skips cells whose plants or families `suite` leaves out; cells
/// that the file lacks are missing. Errors: InputError "FILE: KEY: ..." with what was found and what is
/// allowed; that of foreign_content().
FinishedBoard read_board(const std::filesystem::path& path, const Suite& suite);

/// Makes a leaderboard of the finished board alone.
Leaderboard leaderboard_of(const Suite& suite, FinishedBoard finished);

}  // namespace mpm
