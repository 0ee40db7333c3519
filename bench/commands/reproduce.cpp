#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/reproduction/scenario_quantities.hpp"
#include "analysis/reproduction/seeded_reproduction.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/table_file.hpp"
#include "base/error.hpp"
#include "bench/campaign/reproduction_runs.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/version.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_text.hpp"
#include "results/files/atomic_file.hpp"
#include "results/reproduction/reproduction.hpp"

namespace mpm {
namespace {

struct ReproduceArguments {
  std::string tables = "all";
  std::string output;  ///< empty: no page
  bool json = false;
  std::vector<std::string> changes;  ///< --set, each KEY=VALUE
  std::optional<int> seeds;          ///< none: each table once, with the seeds of its studies
  std::string shard;                 ///< which tables and seeds are run; empty: all are run and shown
  bool dry_run = false;
  bool quiet = false;
  RunOptions run;
};

/// The tables that the command names, with its changes made to their studies.
std::vector<ThesisTable> tables_of(const ReproduceArguments& options) {
  const std::vector<StudyChange> changes = parse_study_changes(options.changes);
  std::vector<ThesisTable> tables = find_tables(options.tables, ScenarioQuantities::known());
  for (ThesisTable& table : tables)
    change_studies(table, changes);
  return tables;
}

template <class Table>
void show(const ReproduceArguments& options, const std::vector<Table>& tables) {
  const Document document = reproduction_document(tables, mpmbench_version(), options.changes);
  if (!options.output.empty())
    write_text(options.output, document_html(document));
  print_result(options.json ? reproduction_json(tables, options.changes) : document_text(document));
}

/// Runs the tables. If it is stopped, the error says how to resume.
std::vector<std::vector<ReproducedTable>> run_tables(TableRuns runs, const ReproduceArguments& options,
                                                     const std::string& command_line) {
  Progress progress(options.quiet, "tables");
  runs.stop = [&progress] { return progress.stop_requested(); };
  runs.on_start = [&progress](std::int64_t done, std::int64_t count) { progress.begin(count, done); };
  runs.on_done = [&progress](bool) { progress.advance(); };
  runs.warn = [&progress](const std::string& text) { progress.warn(text); };
  try {
    return run_tables(runs);
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) +
                             (runs.folder ? how_to_go_on("in " + runs.folder->string(), command_line) : ""));
  }
}

/// Whether numbers can be kept beside the page: beside a device or a pipe there is no place for them.
bool has_place(const std::string& output) {
  return !output.empty() && !is_stream(output);
}

/// What the command would do.
std::string intended_text(const TableRuns& runs, const ReproduceArguments& options) {
  std::string text;
  for (const ThesisTable& table : runs.tables)
    text += fmt::format("{}: {} rows: {}\n", table.label(), table.rows.size(), table.title);
  std::size_t wanted = 0, all = runs.tables.size() * static_cast<std::size_t>(runs.seeds);
  for (std::size_t place = 0; place < all; ++place)
    wanted += is_in_part(place, runs.part) ? 1 : 0;
  return text +
         fmt::format(
             "together: {} tables with {} seeds, {} of {} to run, with {} at once by {}\nfiles: {}\nnothing "
             "was run, nothing was written\n",
             runs.tables.size(), runs.seeds, wanted, all, runs.run.jobs, runs.run.solver,
             options.output.empty()       ? "none"
             : !has_place(options.output) ? options.output
                                          : fmt::format("{0}; until then {0}.tables", options.output));
}

/// Returns ExitCode::done even if verdicts differ: they are results. A part leaves only its numbers, which
/// another call finds.
ExitCode reproduce_tables(const ReproduceArguments& options, const std::string& command_line) {
  if (!options.output.empty())
    require_output_folder(options.output, "page");
  if (!options.shard.empty() && !has_place(options.output))
    throw InputError("--shard", options.output.empty() ? "no --output" : "a device or a pipe for the page",
                     "with --output, a file beside which the parts wait");
  TableRuns runs{.tables = tables_of(options),
                 .seeds = options.seeds.value_or(1),
                 .run = options.run,
                 .part = part_of_option(options.shard)};
  if (options.dry_run) {
    print_result(intended_text(runs, options));
    return ExitCode::done;
  }
  if (has_place(options.output))
    runs.folder = options.output + ".tables";
  const std::vector<std::vector<ReproducedTable>> reproduced = run_tables(runs, options, command_line);
  if (runs.part) {
    print_result(fmt::format("{}: part {} of {} of {} tables with {} seeds\n", runs.folder->string(),
                             runs.part->number, runs.part->of, runs.tables.size(), runs.seeds));
    return ExitCode::done;
  }
  if (options.seeds) {
    std::vector<SeededTable> tables;
    for (const std::vector<ReproducedTable>& of_table : reproduced)
      tables.push_back(over_seeds(of_table));
    show(options, tables);
  } else {
    std::vector<ReproducedTable> tables;
    for (const std::vector<ReproducedTable>& of_table : reproduced)
      tables.push_back(of_table.front());
    show(options, tables);
  }
  remove_kept(runs);
  return ExitCode::done;
}

}  // namespace

void add_reproduce(CommandSet& commands) {
  const auto options = std::make_shared<ReproduceArguments>();
  options->run.solver = "active-set";
  CLI::App& app =
      commands.add("reproduce", "Run the studies behind the tables of the thesis, cell by cell",
                   [options, &commands] { return reproduce_tables(*options, commands.command_line()); });
  app.add_option("TABLES", options->tables, "all, chapter2 to chapter7, or the number of a table such as 4.5")
      ->capture_default_str();
  add_path(app, "-o,--output", options->output,
           "Page to write (HTML). Until then finished tables wait beside it, and the same command resumes");
  add_solver(app, options->run.solver);
  add_json(app, options->json);
  add_changes(app, options->changes, "Change a key in the study of every table, KEY=VALUE; may be repeated");
  app.add_option("--seeds", options->seeds,
                 "Run each table with N seeds, and report medians and the share of seeds that agree")
      ->check(whole_number(1, 100000));
  add_part_of(app, options->shard, "tables and seeds");
  add_untimed_dry_run(app, options->dry_run);
  add_quiet(app, options->quiet);
  add_jobs(app, options->run.jobs, "How many tables run at once, with --solver active-set");
}

}  // namespace mpm
