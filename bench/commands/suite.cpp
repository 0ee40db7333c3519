#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/methods/method_table.hpp"
#include "bench/campaign/suite_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/replaced_archive.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/version.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/figure_format.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/suite/leaderboard_output.hpp"
#include "scenarios/files/suite_file.hpp"

namespace mpm {
namespace {

struct SuiteArguments {
  std::string suite;
  std::string output;
  SuiteChoice choice;
  std::string shard;  ///< which of the cells are run; empty: all of them, and the leaderboard
  RunOptions run;
  std::vector<std::string> method_files;
  bool overwrite = false;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

/// The page and the figure. What has been computed is shown all the same without gnuplot.
void write_pictures(const std::filesystem::path& folder, const Leaderboard& board, Progress& progress) {
  try {
    write_text(folder / "leaderboard.html", document_html(leaderboard_document(board)));
    write_text(folder / "leaderboard.svg", draw_figure(leaderboard_figure(board), FigureFormat::svg));
  } catch (const GnuplotError& error) {
    progress.warn(fmt::format("no page: {}", error.what()));
  }
}

std::vector<IntendedStudy> intended(const Suite& suite, const SuiteRun& run) {
  std::vector<IntendedStudy> studies;
  for (std::size_t cell = 0; cell < suite.cells.size(); ++cell)
    if (run.is_wanted(cell))
      studies.push_back({suite.name_of(suite.cells[cell]), suite.cells[cell].study,
                         suite_archive(suite, suite.cells[cell], run.folder)});
  return studies;
}

/// Runs the suite, or what is missing of it, and shows its leaderboard, which is also left in the folder as a
/// page and as JSON.
ExitCode run_suite_command(const SuiteArguments& options, const std::string& command_line) {
  const Suite suite = find_suite(options.suite, options.choice);
  SuiteRun run{.run = options.run, .folder = options.output, .command = command_line};
  run.run.methods =
      with_programs(options.run.methods, suite.methods, take_method_files(options.method_files));
  run.run.methods = known_methods(run.run.methods.empty() ? suite.methods : run.run.methods,
                                  run.run.methods.empty() ? "suite.methods" : "--methods");
  const std::optional<ShardNumber> shard = shard_of(options.shard);
  run.is_wanted = [&](std::size_t cell) { return is_in_shard(cell, shard); };
  if (options.dry_run) {
    Progress progress(options.quiet);
    print_result(dry_run_text(intended(suite, run), run.run, hooks_of(progress)));
    return ExitCode::done;
  }
  make_output_folder(run.folder, "archives");
  for (const IntendedStudy& study : intended(suite, run)) {
    require_output_archive(study.archive, "archive");
    if (!options.overwrite)
      require_replaceable(study.archive, study_to_run(study.study, run.run), Unreadable::replaced);
  }

  Progress progress(options.quiet);
  std::string cell_name;
  run.hooks = hooks_of(progress);
  run.on_cell = [&](std::size_t cell, bool is_there) {
    cell_name = suite.name_of(suite.cells[cell]);
    progress.note(fmt::format("cell {} of {}: {}{}", cell + 1, suite.cells.size(), cell_name,
                              is_there ? ", done already" : ""));
  };
  std::vector<CellScores> cells;
  try {
    cells = run_suite(suite, run);
  } catch (const Interrupted& error) {
    throw std::runtime_error(fmt::format("{}, in {}{}", progress.explain(error), cell_name,
                                         how_to_go_on("in " + options.output, command_line)));
  }
  for (const CellScores& cell : cells)
    if (!cell.trouble.empty())
      progress.warn(fmt::format("{}.{}: {}", suite.plants[cell.plant].name, suite.families[cell.family].name,
                                cell.trouble));

  if (shard) {
    print_result(fmt::format("{}: {} of {} cells, part {} of {}\n", options.output, cells.size(),
                             suite.cells.size(), shard->number, shard->of));
    return ExitCode::done;
  }
  const Leaderboard board = make_leaderboard(suite, run.run.methods, mpmbench_version(), std::move(cells));
  const std::string json = leaderboard_json(board);
  write_text(run.folder / "leaderboard.json", json);
  write_pictures(run.folder, board, progress);
  print_result(options.json ? json : document_text(leaderboard_document(board), kLeaderboardWidth));
  return ExitCode::done;
}

}  // namespace

void add_suite(CommandSet& commands) {
  const auto options = std::make_shared<SuiteArguments>();
  options->run.store = StorePolicy::none;  // loops are run again from (study, seed, index) when asked for
  options->run.audit_share = 0.0;          // Ipopt answers where the active set does not, and checks nothing
  CLI::App& app =
      commands.add("suite", "Run a suite of plants and families of experiments, and make its leaderboard",
                   [options, &commands] { return run_suite_command(*options, commands.command_line()); });
  add_path(app, "SUITE", options->suite, "Suite file, or name of a shipped suite: standard, quick")
      ->required();
  add_path(app, "-o,--output", options->output,
           "Folder for the archives and the leaderboard; what it has of this suite is kept")
      ->required();
  add_seed(app, options->choice.seed, "Seed of the suite instead of its own: a private suite");
  app.add_option("--plants", options->choice.plants, "These plants only, separated by commas")
      ->delimiter(',');
  app.add_option("--families", options->choice.families, "These families only, separated by commas")
      ->delimiter(',');
  add_shard_of(app, options->shard, "cells");
  add_experiments(app, options->run.experiments, "Run the first N experiments of each cell");
  add_methods_option(app, options->run.methods,
                     "Methods that assess the loops, separated by commas, or all; in place of the suite's");
  add_method_files(app, options->method_files);
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_overwrite(app, options->overwrite);
  add_dry_run(app, options->dry_run);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
