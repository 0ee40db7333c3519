#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/finished_board.hpp"
#include "analysis/findings/leaderboard.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "bench/cache/cache_folder.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/commands/failure_tally.hpp"
#include "bench/commands/study_series.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/version.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/figure_format.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/suite/board_columns.hpp"
#include "results/suite/board_file.hpp"
#include "results/suite/leaderboard_output.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

struct SuiteArguments {
  std::string suite;
  std::string output;
  SuiteChoice choice;
  std::string shard;  ///< which cells are run; empty: all of them, and the leaderboard is made
  RunOptions run;
  std::vector<std::string> method_files;
  std::string join;                    ///< "finished", "none" or a file; empty: see board_to_join()
  std::vector<std::string> highlight;  ///< methods that stand out; empty: the user's that join
  bool overwrite = false;
  bool dry_run = false;
  bool full = false;
  bool json = false;
  bool quiet = false;

  /// Whether nothing is to be run, because the user asks for the finished board.
  bool only_looks() const {
    return output.empty() && run.methods.empty() && method_files.empty() && !choice.seed &&
           !run.experiments && shard.empty() && !overwrite && !dry_run;
  }
};

/// The finished board beside which the user's methods are shown; none: they stand alone. Without --join,
/// these methods join the board of the suite if their loops are those of the suite.
std::optional<FinishedBoard> board_to_join(const SuiteArguments& options, const Suite& suite) {
  const fs::path finished = finished_board_path(suite);
  std::error_code no_status;
  const bool same_loops = !options.choice.seed && !options.run.experiments;
  const bool by_default = options.join.empty() && !options.method_files.empty() && same_loops &&
                          options.shard.empty() && fs::is_regular_file(finished, no_status);
  if (options.join == "none" || (options.join.empty() && !by_default))
    return std::nullopt;
  return read_board(by_default || options.join == "finished" ? finished : fs::path(options.join), suite);
}

/// Makes these methods stand out. Throws InputError for a method that the board does not have.
void highlight(Leaderboard& board, const std::vector<std::string>& methods) {
  for (const std::string& method : methods)
    if (std::find(board.methods.begin(), board.methods.end(), method) == board.methods.end())
      throw InputError("--highlight", with_nearest(method, board.methods),
                       fmt::format("{}", fmt::join(board.methods, ", ")));
  if (!methods.empty())
    board.own = methods;
}

void show_board(const Leaderboard& board, const std::string& json, const SuiteArguments& options) {
  if (options.json)
    return print_result(json);
  print_result(document_text(leaderboard_document(board), kLeaderboardWidth, options.full));
  if (!options.output.empty())
    print_result(fmt::format("The page: {}\n", (fs::path(options.output) / "leaderboard.html").string()));
}

/// Returns the joined board, and warns of what could not be joined.
Leaderboard joined_board(JoinedBoard joined, Progress& progress) {
  for (const std::string& note : joined.notes)
    progress.warn(note);
  return std::move(joined.board);
}

/// Shows the finished board of the suite, without a run. If a board is named, its methods join the finished
/// one.
ExitCode show_finished_board(const SuiteArguments& options, const Suite& suite, Progress& progress) {
  const fs::path path = finished_board_path(suite);
  std::error_code no_status;
  const bool finished = fs::is_regular_file(path, no_status);
  const bool named = !options.join.empty() && options.join != "finished";
  if (options.join == "none" || (!named && !finished))
    throw InputError(
        "--output", "nothing",
        fmt::format("a folder for the archives, since there is no finished board {}", path.string()));
  FinishedBoard shown = read_board(named ? fs::path(options.join) : path, suite);
  Leaderboard board = named && finished ? joined_board(join_boards(suite, shown.methods, shown.program,
                                                                   shown.cells, read_board(path, suite)),
                                                       progress)
                                        : leaderboard_of(suite, std::move(shown));
  highlight(board, options.highlight);
  show_board(board, leaderboard_json(board), options);
  return ExitCode::done;
}

/// Writes the page, the figure and the tables. Without gnuplot it warns that there is no page, and the rest
/// is still shown.
void write_board(const fs::path& folder, const Leaderboard& board, Progress& progress) {
  write_text(folder / "leaderboard.csv", leaderboard_csv(board));
  write_text(folder / "leaderboard.tex", leaderboard_latex(board));
  try {
    write_text(folder / "leaderboard.html", document_html(leaderboard_document(board)));
    write_text(folder / "leaderboard.svg", draw_figure(leaderboard_figure(board), FigureFormat::svg));
  } catch (const GnuplotError& error) {
    progress.warn(fmt::format("no page: {}", error.what()));
  }
}

/// The cells of this part of the suite.
std::vector<const SuiteCell*> cells_of(const Suite& suite, const std::optional<PartNumber>& part) {
  std::vector<const SuiteCell*> cells;
  for (std::size_t place = 0; place < suite.cells.size(); ++place)
    if (is_in_part(place, part))
      cells.push_back(&suite.cells[place]);
  return cells;
}

/// Runs a suite, or what is missing of it, cell by cell, and shows its leaderboard. Writes the leaderboard
/// into the folder as a page, as JSON, CSV and LaTeX, and as a board that others can join. Keeps an archive
/// that is already what this run would make of the cell, so that the same command resumes the suite, and the
/// scores are those of a single run.
ExitCode run_suite(SuiteArguments options, const std::string& command_line) {
  Suite suite = find_suite(options.suite, options.choice);
  Progress progress(options.quiet);
  if (options.only_looks())
    return show_finished_board(options, suite, progress);
  if (options.output.empty())
    options.output = "mpmbench-" + suite.name;
  const auto [programs, table] = take_method_files(options.method_files);
  for (SuiteCell& cell : suite.cells)
    cell.study.assessment.table = table;
  const std::optional<FinishedBoard> finished = board_to_join(options, suite);
  RunOptions run = options.run;
  run.methods = finished && !programs.empty() && options.run.methods.empty()
                    ? programs
                    : with_programs(options.run.methods, suite.methods, programs);
  run.methods = table->known(run.methods.empty() ? suite.methods : run.methods,
                             run.methods.empty() ? "suite.methods" : "--methods");
  run.cache = user_cache();
  run.threshold_options = threshold_options(options.method_files);
  const fs::path folder = options.output;
  const std::optional<PartNumber> part = part_of_option(options.shard);
  const std::vector<const SuiteCell*> cells = cells_of(suite, part);
  std::vector<IntendedStudy> studies;
  for (const SuiteCell* const cell : cells)
    studies.push_back({fmt::format("cell {} of {}", cell - suite.cells.data() + 1, suite.cells.size()),
                       suite.name_of(*cell), cell->study,
                       folder / fmt::format("{}.h5", suite.name_of(*cell))});
  if (options.dry_run) {
    print_result(dry_run_text(studies, run, hooks_of(progress)));
    return ExitCode::done;
  }
  require_archives(studies, folder, run, options.overwrite);
  std::vector<CellScores> scores;
  FailureTally failures;
  run_series(studies, run, progress, options.output, command_line, [&](std::size_t place, KeptRun kept) {
    const SuiteCell& cell = *cells[place];
    if (!kept.campaign) {
      scores.push_back({.plant = cell.plant,
                        .family = cell.family,
                        .seed = cell.study.seed,
                        .trouble = std::move(kept.trouble)});
      return;
    }
    const StudyFindings findings = findings_of(*kept.campaign);
    failures.add(findings);
    scores.push_back(cell_scores(cell, findings));
  });
  failures.tell(progress);

  if (part) {
    print_result(fmt::format("{}: {} of {} cells, part {} of {}\n", options.output, scores.size(),
                             suite.cells.size(), part->number, part->of));
    return ExitCode::done;
  }
  Leaderboard board = make_leaderboard(suite, run.methods, mpmbench_version(), scores);
  write_text(folder / board_file_name(suite), board_text(suite, board, source_revision()));
  if (finished)
    board = joined_board(join_boards(suite, run.methods, mpmbench_version(), std::move(scores), *finished),
                         progress);
  highlight(board, options.highlight);
  const std::string json = leaderboard_json(board);
  write_text(folder / "leaderboard.json", json);
  write_board(folder, board, progress);
  show_board(board, json, options);
  return ExitCode::done;
}

}  // namespace

void add_suite(CommandSet& commands) {
  const auto options = std::make_shared<SuiteArguments>();
  options->run.store = StorePolicy::none;  // loops are run again from (study, seed, index) when asked for
  options->run.audit_share = 0.0;  // Ipopt solves what the active-set method does not, and checks nothing
  CLI::App& app =
      commands.add("suite", "Run a suite of plants and families of experiments, and make its leaderboard",
                   [options, &commands] { return run_suite(*options, commands.command_line()); });
  add_path(app, "SUITE", options->suite, "Suite file, or name of a shipped suite: standard, exact, quick")
      ->required();
  add_path(app, "-o,--output", options->output,
           "Folder for the archives and the leaderboard; finished cells in it are kept (default: "
           "mpmbench-SUITE; without anything to run, the finished board is shown)");
  add_seed(app, options->choice.seed, "Another seed for the suite: a private suite",
           std::uint64_t{1} << 53U);  // a board file keeps it as a number of JSON
  app.add_option("--plants", options->choice.plants, "Only these plants, separated by commas")
      ->delimiter(',');
  app.add_option("--families", options->choice.families, "Only these families, separated by commas")
      ->delimiter(',');
  add_part_of(app, options->shard, "cells");
  add_experiments(app, options->run.experiments, "Run the first N experiments of each cell");
  add_methods_option(
      app, options->run.methods,
      "Methods that assess the loops, separated by commas, or all (default: those of the suite)");
  add_method_files(app, options->method_files);
  add_path(app, "--join", options->join,
           "Show the run beside the methods of a board: finished, none, or a file SUITE.board.json (default: "
           "finished with --method-file, where the loops are those of the suite)");
  app.add_option("--highlight", options->highlight,
                 "Methods to mark and to rank, separated by commas (default: those that join a board)")
      ->delimiter(',');
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_overwrite(app, options->overwrite);
  add_fresh(app, options->run.fresh);
  add_dry_run(app, options->dry_run);
  add_full(app, options->full);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
