#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/methods/method_table.hpp"
#include "bench/campaign/kept_campaign.hpp"
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

namespace fs = std::filesystem;

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
void write_pictures(const fs::path& folder, const Leaderboard& board, Progress& progress) {
  try {
    write_text(folder / "leaderboard.html", document_html(leaderboard_document(board)));
    write_text(folder / "leaderboard.svg", draw_figure(leaderboard_figure(board), FigureFormat::svg));
  } catch (const GnuplotError& error) {
    progress.warn(fmt::format("no page: {}", error.what()));
  }
}

/// The cells of this part of the suite, each with its archive in this folder.
std::vector<std::pair<const SuiteCell*, IntendedStudy>> cells_of(const Suite& suite, const fs::path& folder,
                                                                 const std::optional<PartNumber>& part) {
  std::vector<std::pair<const SuiteCell*, IntendedStudy>> cells;
  for (std::size_t place = 0; place < suite.cells.size(); ++place)
    if (const SuiteCell& cell = suite.cells[place]; is_in_part(place, part))
      cells.emplace_back(&cell, IntendedStudy{suite.name_of(cell), cell.study,
                                              folder / fmt::format("{}.h5", suite.name_of(cell))});
  return cells;
}

/// Runs a suite, or what is missing of it, cell by cell, and shows its leaderboard, which is also left in the
/// folder as a page and as JSON. An archive that is there and is what this run would make of the cell is kept
/// as it is, so that the same command goes on, and the scores are those of one go.
ExitCode run_suite(const SuiteArguments& options, const std::string& command_line) {
  const Suite suite = find_suite(options.suite, options.choice);
  RunOptions run = options.run;
  run.methods = with_programs(options.run.methods, suite.methods, take_method_files(options.method_files));
  run.methods = known_methods(run.methods.empty() ? suite.methods : run.methods,
                              run.methods.empty() ? "suite.methods" : "--methods");
  const fs::path folder = options.output;
  const std::optional<PartNumber> part = part_of_option(options.shard);
  const auto cells = cells_of(suite, folder, part);
  std::vector<IntendedStudy> studies;
  for (const auto& [cell, study] : cells)
    studies.push_back(study);
  Progress progress(options.quiet);
  if (options.dry_run) {
    print_result(dry_run_text(studies, run, hooks_of(progress)));
    return ExitCode::done;
  }
  make_output_folder(folder, "archives");
  for (const IntendedStudy& study : studies) {
    require_output_archive(study.archive, "archive");
    if (!options.overwrite)
      require_replaceable(study.archive, study_to_run(study.study, run), Unreadable::replaced);
  }

  std::vector<CellScores> scores;
  std::vector<std::string> troubles;
  for (const auto& [cell, study] : cells)
    try {
      const std::string name =
          fmt::format("cell {} of {}: {}", cell - suite.cells.data() + 1, suite.cells.size(), study.name);
      const KeptRun kept = run_unless_kept(
          study.archive, study.study, run, hooks_of(progress), command_line,
          [&progress, &name](bool is_there) { progress.note(name + (is_there ? ", done already" : "")); });
      scores.push_back(kept.campaign ? cell_scores(*cell, findings_of(*kept.campaign))
                                     : CellScores{.plant = cell->plant,
                                                  .family = cell->family,
                                                  .seed = cell->study.seed,
                                                  .trouble = kept.trouble});
      if (!kept.trouble.empty())
        troubles.push_back(fmt::format("{}: {}", study.name, kept.trouble));
    } catch (const Interrupted& error) {
      throw std::runtime_error(fmt::format("{}, in {}{}", progress.explain(error), study.name,
                                           how_to_go_on("in " + options.output, command_line)));
    }
  for (const std::string& trouble : troubles)
    progress.warn(trouble);

  if (part) {
    print_result(fmt::format("{}: {} of {} cells, part {} of {}\n", options.output, scores.size(),
                             suite.cells.size(), part->number, part->of));
    return ExitCode::done;
  }
  const Leaderboard board = make_leaderboard(suite, run.methods, mpmbench_version(), std::move(scores));
  const std::string json = leaderboard_json(board);
  write_text(folder / "leaderboard.json", json);
  write_pictures(folder, board, progress);
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
                   [options, &commands] { return run_suite(*options, commands.command_line()); });
  add_path(app, "SUITE", options->suite, "Suite file, or name of a shipped suite: standard, exact, quick")
      ->required();
  add_path(app, "-o,--output", options->output,
           "Folder for the archives and the leaderboard; finished cells in it are kept")
      ->required();
  add_seed(app, options->choice.seed, "Another seed for the suite: a private suite");
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
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_overwrite(app, options->overwrite);
  add_dry_run(app, options->dry_run);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
