#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/board_rerun.hpp"
#include "analysis/findings/finished_board.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "results/document/document.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/plot_text.hpp"
#include "results/suite/board_file.hpp"
#include "results/suite/leaderboard_output.hpp"

namespace mpm {
namespace {

constexpr double kSignificance = 0.05;  // of all rates of a rerun together

struct CheckBoardArguments {
  std::string board;
  std::string suite;
  std::string rerun;  ///< the board of a run on another seed; empty: none
};

/// The reasons, in sentences, why these results cannot join the board of the suite.
std::vector<std::string> troubles_of(const Suite& suite, const FinishedBoard& board,
                                     const FinishedBoard& finished, const JoinedBoard& joined) {
  std::vector<std::string> troubles = joined.notes;
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

std::string suite_of(const CheckBoardArguments& options) {
  return options.suite.empty() ? board_heading(options.board).suite : options.suite;
}

/// What the file says about its methods, without their place among other methods: nobody has run them again.
Section stated_section(const Leaderboard& board) {
  Section section = standing_section(board);
  section.title = "What the file says";
  section.content.erase(section.content.begin(), section.content.end() - 1);  // all but the table
  return section;
}

/// Compares the rates of the file with those of a run of the same methods on another seed.
std::vector<RerunRate> rates_again(const CheckBoardArguments& options, const Suite& suite,
                                   const FinishedBoard& board) {
  const BoardHeading heading = board_heading(options.rerun);
  if (heading.seed == suite.seed)
    throw InputError("--rerun",
                     fmt::format("{} under seed {}, that of the suite", options.rerun, heading.seed),
                     "a run under another seed, which nobody knew before");
  const Suite again = find_suite(suite_of(options), {.seed = heading.seed});
  std::vector<std::string_view> rates = question_rates();
  for (const std::string_view name : {"answered", "false_alarm_healthy", "false_alarm_calibrated", "located"})
    rates.push_back(name);
  std::vector<RerunRate> found = rerun_rates(leaderboard_of(suite, board),
                                             leaderboard_of(again, read_board(options.rerun, again)), rates);
  if (found.empty())
    throw InputError("--rerun",
                     fmt::format("{} with none of {}", options.rerun, fmt::join(board.methods, ", ")),
                     "a run of these methods");
  return found;
}

Section rerun_section(const std::vector<RerunRate>& rates, const std::string& file) {
  Section section{"rerun", "The same methods on another seed"};
  Table table(fmt::format("% of all loops with 95 % interval: the file, and {}", as_label(file)),
              {{"Method", Table::Align::left},
               {"Rate", Table::Align::left},
               {"file"},
               {"rerun"},
               {"difference"},
               {"p, corrected"}});
  for (const RerunRate& each : rates)
    table.row(
        {as_label(each.method), heading_of(each.rate), number(each.stated, NumberForm::whole_percent),
         number(each.again, NumberForm::whole_percent),
         Number{each.difference.value, NumberForm::whole_percent, each.difference.interval},
         Cell(fixed(each.p_holm)).toned(each.differs(kSignificance) ? Cell::Tone::bad : Cell::Tone::plain)});
  section.add(std::move(table));
  const auto other = std::count_if(rates.begin(), rates.end(),
                                   [](const RerunRate& each) { return each.differs(kSignificance); });
  section.say(
      other == 0
          ? fmt::format("No rate differs beyond chance (p < {:g}, corrected for {} rates).", kSignificance,
                        rates.size())
          : fmt::format(
                "{} of {} rates differ beyond chance: the file does not have the answers of the method.",
                other, rates.size()));
  return section;
}

/// Reads the results of methods and compares them with the suite and its finished board, and with a run on
/// another seed if there is one. No file can prove that a method gave its answers.
ExitCode check_board(const CheckBoardArguments& options) {
  const Suite suite = find_suite(suite_of(options));
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
  text += wrapped(
      troubles.empty()
          ? "Checked: suite, version and seed; the studies, kinds, CVs and worlds of all loops are those "
            "that "
            "the suite draws; names are free; no answer is impossible. Not checked, because no file can show "
            "it: whether the method gave these answers. A maintainer's rerun on a fresh seed decides "
            "(--rerun)."
          : "It cannot be submitted as it is.",
      kLeaderboardWidth);

  Document document;
  document.sections.push_back(stated_section(leaderboard_of(suite, board)));
  bool agrees = true;
  if (!options.rerun.empty()) {
    const std::vector<RerunRate> rates = rates_again(options, suite, board);
    agrees = std::none_of(rates.begin(), rates.end(),
                          [](const RerunRate& each) { return each.differs(kSignificance); });
    document.sections.push_back(rerun_section(rates, options.rerun));
  }
  print_result(text + document_text(document, kLeaderboardWidth));
  return troubles.empty() && agrees ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_check_board(CommandSet& commands) {
  const auto options = std::make_shared<CheckBoardArguments>();
  CLI::App& app = commands.add(
      "check-board", "Are the results of a method complete and possible, and does a rerun agree with them?",
      [options] { return check_board(*options); });
  add_path(app, "BOARD", options->board, "SUITE.board.json that `suite` has written")->required();
  add_path(app, "--suite", options->suite, "File of your own suite (default: the shipped one)");
  add_path(app, "--rerun", options->rerun,
           "SUITE.board.json of the same methods under another seed (suite --seed N): its rates are compared "
           "with those of the file");
}

}  // namespace mpm
