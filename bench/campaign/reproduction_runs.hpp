#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"
#include "bench/campaign/kept_tables.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/execution/stop_request.hpp"
#include "bench/parts/launcher.hpp"

namespace mpm {

/// How the tables of the thesis are run.
struct TableRuns {
  std::vector<ThesisTable> tables;
  int seeds = 1;                          ///< those of their studies, these plus 1, ...
  RunOptions run;                         ///< solver and threads; the rest stands in the files of the tables
  const KeptTables* kept = nullptr;       ///< where numbers are kept; none: in memory
  std::optional<ShardNumber> shard = {};  ///< which piece of the tables and seeds is run; none: all
  StopRequest stop = {};
  std::function<void(std::int64_t done, std::int64_t count)> on_start = {};
  std::function<void()> on_done = {};  ///< after each table and seed; one call at a time, from any thread
};

/// Every table with each seed: result[table][seed], by `run.solver`, in `run.jobs` threads, or in one with
/// another solver than active-set, since Ipopt has no threads; the result is the same, however often it was
/// stopped. Of a piece, the tables that are neither in it nor kept are without rows. Errors: as
/// table_numbers(), that of the first table and seed; Interrupted; ArchiveError.
std::vector<std::vector<ReproducedTable>> run_tables(const TableRuns& runs);

/// Removes what is kept of these tables with these seeds: the page is written.
void remove_kept(const TableRuns& runs);

}  // namespace mpm
