#include "bench/campaign/reproduction_runs.hpp"

#include <optional>
#include <utility>

#include "analysis/reproduction/seeded_reproduction.hpp"
#include "bench/execution/thread_loop.hpp"

namespace mpm {

namespace {

/// All tables with one seed. Tables that have a study in common find its basis case made.
std::vector<ReproducedTable> run_seed(const std::vector<ThesisTable>& tables, std::uint64_t offset,
                                      const QpSolverFactory& factory, int jobs) {
  BasisCases basis_cases(factory);
  std::vector<ReproducedTable> done(tables.size());
  for_each_in_threads(tables.size(), jobs, [&](std::size_t table, std::size_t) {
    done[table] = reproduce(with_seed_offset(tables[table], offset), factory, basis_cases);
  });
  return done;
}

}  // namespace

std::vector<std::vector<ReproducedTable>> run_tables(const std::vector<ThesisTable>& tables, int seed_count,
                                                     const RunOptions& options) {
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  const int jobs = options.solver == "active-set" ? options.jobs : 1;  // Ipopt has no threads
  std::vector<std::vector<ReproducedTable>> result(tables.size());
  for (int seed = 0; seed < seed_count; ++seed) {
    std::vector<ReproducedTable> of_seed = run_seed(tables, static_cast<std::uint64_t>(seed), factory, jobs);
    for (std::size_t table = 0; table < tables.size(); ++table)
      result[table].push_back(std::move(of_seed[table]));
  }
  return result;
}

}  // namespace mpm
