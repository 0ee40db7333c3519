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
  int seeds = 1;   ///< those of their studies, these plus 1, ...
  RunOptions run;  ///< solver and threads; the rest stands in the files of the tables
  std::optional<std::filesystem::path> folder = {};  ///< where numbers wait for their page; none: in memory
  std::optional<PartNumber> part = {};               ///< which of the tables and seeds are run; none: all
  StopRequest stop = {};
  std::function<void(std::int64_t done, std::int64_t count)> on_start = {};
  std::function<void(bool failed)> on_done = {};  ///< one call at a time, from any thread
  ShardStore::Warn warn = {};
};

/// Every table with each seed: result[table][seed], by `run.solver`, in `run.jobs` threads, or in one with
/// another solver than active-set, since Ipopt has no threads; the result is the same, however often it was
/// stopped. Of a part, the tables that are neither in it nor kept are without rows. Numbers that are kept of
/// another program, solver or table are made anew. Errors: as table_numbers(), that of the first table and
/// seed; Interrupted; ArchiveError.
std::vector<std::vector<ReproducedTable>> run_tables(const TableRuns& runs);

/// Removes what is kept of these tables with these seeds: the page is written. Numbers of other tables and
/// seeds wait for another page.
void remove_kept(const TableRuns& runs);

}  // namespace mpm
