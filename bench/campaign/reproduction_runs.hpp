#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/execution/stop_request.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/shards/shard_store.hpp"

namespace mpm {

/// How the tables of the thesis are run.
struct TableRuns {
  std::vector<ThesisTable> tables;
  int seeds = 1;   ///< how many: those of the studies, those plus 1, ...
  RunOptions run;  ///< solver and threads; the rest stands in the files of the tables
  std::optional<std::filesystem::path> folder = {};  ///< where numbers wait for their page; none: in memory
  std::optional<PartNumber> part = {};               ///< which of the tables and seeds are run; none: all
  StopRequest stop = {};
  std::function<void(std::int64_t done, std::int64_t count)> on_start = {};
  std::function<void(bool failed)> on_done = {};  ///< one call at a time, from any thread
  ShardStore::Warn warn = {};
};

/// Runs every table with each seed and returns result[table][seed]. The solver is `run.solver`, in `run.jobs`
/// threads if it is active-set and in one thread otherwise, since Ipopt has no threads. The result is the
/// same however often the run was stopped. With a part, tables that are neither in it nor kept have no rows.
/// Kept numbers of another program, solver or table are made anew. Errors: as table_numbers(), for the first
/// table and seed; Interrupted; ArchiveError.
std::vector<std::vector<ReproducedTable>> run_tables(const TableRuns& runs);

/// Removes the kept numbers of these tables with these seeds, once their page is written. Numbers of other
/// tables and seeds stay, for another page.
void remove_kept(const TableRuns& runs);

}  // namespace mpm
