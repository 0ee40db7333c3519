#include "bench/campaign/reproduction_runs.hpp"

#include <exception>
#include <optional>
#include <utility>

#include "analysis/reproduction/seeded_reproduction.hpp"

namespace mpm {

std::vector<std::vector<ReproducedTable>> run_tables(const std::vector<ThesisTable>& tables, int seed_count,
                                                     const RunOptions& options) {
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  const int jobs = options.solver == "active-set" ? options.jobs : 1;  // Ipopt has no threads
  const auto seeds = static_cast<std::size_t>(seed_count);
  const std::size_t runs = tables.size() * seeds;
  std::vector<std::optional<ReproducedTable>> done(runs);
  std::vector<std::exception_ptr> failures(runs);  // none may leave a thread
#pragma omp parallel for schedule(dynamic) num_threads(jobs)
  for (std::size_t run = 0; run < runs; ++run) {
    try {
      done[run] = reproduce(with_seed_offset(tables[run / seeds], run % seeds), factory);
    } catch (...) {
      failures[run] = std::current_exception();
    }
  }
  std::vector<std::vector<ReproducedTable>> result(tables.size());
  for (std::size_t run = 0; run < runs; ++run) {
    if (failures[run])
      std::rethrow_exception(failures[run]);
    result[run / seeds].push_back(std::move(*done[run]));
  }
  return result;
}

}  // namespace mpm
