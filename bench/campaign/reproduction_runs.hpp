#pragma once

#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"
#include "bench/execution/run_options.hpp"

namespace mpm {

/// Every table with the seeds of its studies, with these plus 1, ... up to `seed_count` of them:
/// result[table][seed]. By `options.solver`, in `options.jobs` threads, or in one with another solver
/// than active-set, since Ipopt has no threads; the result is the same. The other options say nothing here:
/// what a table runs stands in its file. Errors: as reproduce(), that of the first table and seed.
std::vector<std::vector<ReproducedTable>> run_tables(const std::vector<ThesisTable>& tables, int seed_count,
                                                     const RunOptions& options);

}  // namespace mpm
