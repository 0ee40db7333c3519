#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "analysis/findings/finished_board.hpp"
#include "analysis/study_files/suite_file.hpp"

// The file SUITE.board.json (docs/suite.md): a letter for each loop and method, from which the rates of a
// leaderboard are counted again, and a method of one's own is paired with those in the file.

namespace mpm {

/// "standard.board.json"
std::string board_file_name(const Suite& suite);

/// The finished board that lies beside the file of the suite, whether it is there or not.
std::filesystem::path finished_board_path(const Suite& suite);

/// Such a file itself, or the one in the folder of a run; none where it is neither. Errors: InputError for a
/// folder with several.
std::optional<std::filesystem::path> find_board(const std::filesystem::path& path);

/// The suite that such a file says it is of, and the seed of the run.
struct BoardHeading {
  std::string suite;
  std::uint64_t seed;
};
/// Errors: as read_board().
BoardHeading board_heading(const std::filesystem::path& path);

/// The text of such a file. `board` is of cells of this suite. Shares of repairs and delays are rounded to
/// four digits.
std::string board_text(const Suite& suite, const Leaderboard& board, const std::string& revision);

/// Reads such a file, which somebody else may have written, and compares it with the suite: its name, version
/// and seed, and of each cell the study. Cells of plants and families that `suite` leaves out are skipped,
/// and cells that the file lacks are not there. Errors: InputError "FILE: KEY: ..." with what was found and
/// what is allowed; that of foreign_content().
FinishedBoard read_board(const std::filesystem::path& path, const Suite& suite);

/// Of such a board alone.
Leaderboard leaderboard_of(const Suite& suite, FinishedBoard finished);

}  // namespace mpm
