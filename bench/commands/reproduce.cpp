#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/reproduction/scenario_quantities.hpp"
#include "analysis/reproduction/seeded_reproduction.hpp"
#include "bench/campaign/reproduction_runs.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/files/output_file.hpp"
#include "bench/version.hpp"
#include "results/reproduction/reproduction.hpp"
#include "results/reproduction/seeded_reproduction.hpp"
#include "scenarios/study_change.hpp"

namespace mpm {
namespace {

struct ReproduceArguments {
  std::string tables = "all";
  std::string output;  ///< no page when empty
  bool json = false;
  std::vector<std::string> changes;  ///< --set, each KEY=VALUE
  std::optional<int> seeds;          ///< none: each table once, with the seeds of its studies
  RunOptions run;
};

/// The tables that the command names, with its changes made to their studies.
std::vector<ThesisTable> tables_of(const ReproduceArguments& options) {
  std::vector<StudyChange> changes;
  for (const std::string& text : options.changes)
    changes.push_back(parse_study_change(text));
  std::vector<ThesisTable> tables = find_tables(options.tables, ScenarioQuantities::known());
  for (ThesisTable& table : tables)
    change_studies(table, changes);
  return tables;
}

void write_page(const std::string& output, const std::string& page) {
  if (!output.empty())
    write_text(output, page);
}

void show(const ReproduceArguments& options, const std::vector<ReproducedTable>& tables) {
  write_page(options.output, reproduction_html(tables, mpmbench_version(), options.changes));
  print_result(options.json ? reproduction_json(tables, options.changes)
                            : reproduction_text(tables, options.changes));
}

void show_over_seeds(const ReproduceArguments& options, const std::vector<SeededTable>& tables) {
  write_page(options.output, seeded_reproduction_html(tables, mpmbench_version(), options.changes));
  print_result(options.json ? seeded_reproduction_json(tables, options.changes)
                            : seeded_reproduction_text(tables, options.changes));
}

/// Done even when verdicts differ: they are results.
ExitCode reproduce_tables(const ReproduceArguments& options) {
  if (!options.output.empty())
    require_output_folder(options.output, "page");
  const std::vector<std::vector<ReproducedTable>> runs =
      run_tables(tables_of(options), options.seeds.value_or(1), options.run);
  if (options.seeds) {
    std::vector<SeededTable> tables;
    for (const std::vector<ReproducedTable>& of_table : runs)
      tables.push_back(over_seeds(of_table));
    show_over_seeds(options, tables);
  } else {
    std::vector<ReproducedTable> tables;
    for (const std::vector<ReproducedTable>& of_table : runs)
      tables.push_back(of_table.front());
    show(options, tables);
  }
  return ExitCode::done;
}

}  // namespace

void add_reproduce(CommandSet& commands) {
  const auto options = std::make_shared<ReproduceArguments>();
  options->run.solver = "active-set";
  CLI::App& app = commands.add("reproduce", "Run the studies behind the tables of the thesis, cell by cell",
                               [options] { return reproduce_tables(*options); });
  app.add_option("TABLES", options->tables, "all, chapter2 to chapter7, or the number of a table such as 4.5")
      ->capture_default_str();
  add_path(app, "-o,--output", options->output, "Page to write (HTML)");
  add_solver(app, options->run.solver);
  add_json(app, options->json);
  app.add_option("--set", options->changes,
                 "A key of the study of every table with another value, KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--seeds", options->seeds,
                 "Run each table with N seeds, and report medians and the share of seeds that agree")
      ->check(whole_number(1, 100000));
  add_jobs(app, options->run.jobs, "How many tables run at once, with --solver active-set");
}

}  // namespace mpm
