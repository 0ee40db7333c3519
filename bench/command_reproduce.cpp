#include "bench/command_reproduce.hpp"

#include <span>

#include <fmt/format.h>

#include "analysis/reproduction/scenario_quantities.hpp"
#include "analysis/reproduction/seeded_reproduction.hpp"
#include "bench/files.hpp"
#include "bench/reproduction_runs.hpp"
#include "bench/version.hpp"
#include "results/files/atomic_file.hpp"
#include "results/reproduction/reproduction.hpp"
#include "results/reproduction/seeded_reproduction.hpp"
#include "scenarios/study_change.hpp"

namespace mpm {
namespace {

/// The tables that the command names, with its changes made to their studies.
std::vector<ThesisTable> tables_of(const ReproduceCommand& command) {
  std::vector<StudyChange> changes;
  for (const std::string& text : command.changes)
    changes.push_back(parse_study_change(text));
  std::vector<ThesisTable> tables = find_tables(command.tables, ScenarioQuantities::known());
  for (ThesisTable& table : tables)
    change_studies(table, changes);
  return tables;
}

void write_page(const std::string& path, const std::string& page) {
  if (!path.empty())
    write_file_atomically(path, std::as_bytes(std::span(page)));
}

void show(const ReproduceCommand& command, const std::vector<ReproducedTable>& tables) {
  write_page(command.output, reproduction_html(tables, mpmbench_version(), command.changes));
  fmt::print("{}", command.json ? reproduction_json(tables, command.changes)
                                : reproduction_text(tables, command.changes));
}

void show_over_seeds(const ReproduceCommand& command, const std::vector<SeededTable>& tables) {
  write_page(command.output, seeded_reproduction_html(tables, mpmbench_version(), command.changes));
  fmt::print("{}", command.json ? seeded_reproduction_json(tables, command.changes)
                                : seeded_reproduction_text(tables, command.changes));
}

}  // namespace

ExitCode reproduce_tables(const ReproduceCommand& command) {
  if (!command.output.empty())
    require_output_folder(command.output, "page");
  const std::vector<std::vector<ReproducedTable>> runs =
      run_tables(tables_of(command), {command.seeds.value_or(1), command.jobs, command.solver});
  if (command.seeds) {
    std::vector<SeededTable> tables;
    for (const std::vector<ReproducedTable>& of_table : runs)
      tables.push_back(over_seeds(of_table));
    show_over_seeds(command, tables);
  } else {
    std::vector<ReproducedTable> tables;
    for (const std::vector<ReproducedTable>& of_table : runs)
      tables.push_back(of_table.front());
    show(command, tables);
  }
  return ExitCode::done;
}

}  // namespace mpm
