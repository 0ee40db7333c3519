#include "bench/campaign/reproduction_runs.hpp"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <utility>

#include "analysis/reproduction/seeded_reproduction.hpp"
#include "bench/execution/thread_loop.hpp"

namespace mpm {
namespace {

/// A table with one seed.
struct TableRun {
  ThesisTable table;
  std::uint64_t offset;
  bool wanted;
  std::optional<TableNumbers> numbers;
};

std::vector<TableRun> listed(const TableRuns& runs) {
  std::vector<TableRun> list;
  for (int seed = 0; seed < runs.seeds; ++seed)
    for (const ThesisTable& table : runs.tables) {
      const auto offset = static_cast<std::uint64_t>(seed);
      TableRun& run = list.emplace_back(TableRun{with_seed_offset(table, offset), offset, false, {}});
      run.wanted = is_in_shard(list.size() - 1, runs.shard);
      if (runs.kept != nullptr)
        run.numbers = runs.kept->find(run.table, offset);
    }
  return list;
}

/// Runs what is missing. Tables that have a study in common, with one seed, find its basis case made.
void run_missing(std::vector<TableRun>& list, const TableRuns& runs) {
  const QpSolverFactory factory = qp_solver_factory(runs.run.solver);
  const int jobs = runs.run.solver == "active-set" ? runs.run.jobs : 1;  // Ipopt has no threads
  std::mutex one_at_a_time;
  for (std::size_t first = 0; first < list.size(); first += runs.tables.size()) {
    BasisCases basis_cases(factory);
    for_each_in_threads(runs.tables.size(), jobs, [&](std::size_t table, std::size_t) {
      TableRun& run = list[first + table];
      if (!run.wanted || run.numbers || requested(runs.stop))
        return;
      run.numbers = table_numbers(run.table, factory, basis_cases);
      const std::lock_guard alone(one_at_a_time);
      if (runs.kept != nullptr)
        runs.kept->keep(run.table, run.offset, *run.numbers);
      if (runs.on_done)
        runs.on_done();
    });
  }
}

}  // namespace

std::vector<std::vector<ReproducedTable>> run_tables(const TableRuns& runs) {
  std::vector<TableRun> list = listed(runs);
  const auto done = [&] {
    return std::count_if(list.begin(), list.end(),
                         [](const TableRun& run) { return run.wanted && run.numbers; });
  };
  const std::int64_t count =
      std::count_if(list.begin(), list.end(), [](const TableRun& run) { return run.wanted; });
  if (runs.on_start)
    runs.on_start(done(), count);
  run_missing(list, runs);
  if (done() < count)
    throw Interrupted(done(), count, "tables");
  std::vector<std::vector<ReproducedTable>> result(runs.tables.size());
  for (std::size_t i = 0; i < list.size(); ++i)
    result[i % runs.tables.size()].push_back(list[i].numbers
                                                 ? reproduced(std::move(list[i].table), *list[i].numbers)
                                                 : ReproducedTable{std::move(list[i].table), {}});
  return result;
}

void remove_kept(const TableRuns& runs) {
  if (runs.kept == nullptr)
    return;
  for (const ThesisTable& table : runs.tables)
    for (int seed = 0; seed < runs.seeds; ++seed)
      runs.kept->remove(table, static_cast<std::uint64_t>(seed));
}

}  // namespace mpm
