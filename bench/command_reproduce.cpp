#include "bench/command_reproduce.hpp"

#include <span>

#include <fmt/format.h>

#include "analysis/scenario_quantities.hpp"
#include "bench/files.hpp"
#include "bench/version.hpp"
#include "results/atomic_file.hpp"
#include "results/reproduction.hpp"

namespace mpm {

ExitCode reproduce_tables(const ReproduceCommand& command) {
  if (!command.output.empty())
    require_output_folder(command.output, "page");
  const QpSolverFactory factory = qp_solver_factory(command.solver);
  std::vector<ReproducedTable> tables;
  for (const ThesisTable& table : find_tables(command.tables, ScenarioQuantities::known()))
    tables.push_back(reproduce(table, factory));
  if (!command.output.empty()) {
    const std::string page = reproduction_html(tables, mpmbench_version());
    write_file_atomically(command.output, std::as_bytes(std::span(page)));
  }
  fmt::print("{}", command.json ? reproduction_json(tables) : reproduction_text(tables));
  return ExitCode::done;
}

}  // namespace mpm
