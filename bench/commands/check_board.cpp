#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/finished_board.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/version.hpp"
#include "results/document/document_text.hpp"
#include "results/suite/board_file.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

struct CheckBoardArguments {
  std::string board;
  std::string suite;
};

/// Why these results cannot stand on the board of the suite, in sentences.
std::vector<std::string> troubles_of(const Suite& suite, const FinishedBoard& board,
                                     const FinishedBoard& finished, const JoinedBoard& joined) {
  std::vector<std::string> troubles = joined.notes;
  if (board.program != mpmbench_version())
    troubles.push_back(fmt::format("it was made by mpmbench {}, and the finished board is of {}",
                                   board.program, finished.program));
  for (const SuiteCell& cell : suite.cells)
    if (std::none_of(board.cells.begin(), board.cells.end(), [&cell](const CellScores& each) {
          return each.plant == cell.plant && each.family == cell.family;
        }))
      troubles.push_back(fmt::format("{}: the cell is missing", suite.name_of(cell)));
  for (const std::string& method : board.methods)
    if (std::find(finished.methods.begin(), finished.methods.end(), method) != finished.methods.end())
      troubles.push_back(fmt::format("{}: the finished board has a method of this name", method));
  return troubles;
}

/// Reads the results of methods, holds them against the finished board of their suite, and says whether they
/// could stand on it, and where.
ExitCode check_board(const CheckBoardArguments& options) {
  const Suite suite = find_suite(options.suite.empty() ? board_heading(options.board).suite : options.suite);
  const FinishedBoard board = read_board(options.board, suite);
  const FinishedBoard finished = read_board(finished_board_path(suite), suite);
  const JoinedBoard joined = join_boards(suite, board.methods, board.program, board.cells, finished);
  const std::vector<std::string> troubles = troubles_of(suite, board, finished, joined);

  std::int64_t experiments = 0;
  for (const CellScores& cell : board.cells)
    experiments += cell.experiments;
  std::string text = fmt::format("{}: {} on {} of {} cells of suite {} {}, {} experiments, by {}\n",
                                 options.board, fmt::join(board.methods, ", "), board.cells.size(),
                                 suite.cells.size(), suite.name, suite.version, experiments, board.runner());
  for (const std::string& trouble : troubles)
    text += wrapped("- " + trouble, kLeaderboardWidth, "  ");
  text += troubles.empty() ? "It can stand on the board.\n" : "It cannot stand on the board as it is.\n";

  Document standing;
  standing.sections.push_back(standing_section(joined.board));
  print_result(text + document_text(standing, kLeaderboardWidth));
  return troubles.empty() ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_check_board(CommandSet& commands) {
  const auto options = std::make_shared<CheckBoardArguments>();
  CLI::App& app =
      commands.add("check-board", "Can the results of a method stand on the finished board of a suite?",
                   [options] { return check_board(*options); });
  add_path(app, "BOARD", options->board, "SUITE.board.json that `suite` has written")->required();
  add_path(app, "--suite", options->suite, "File of a suite of one's own (default: the shipped one)");
}

}  // namespace mpm
