#include "bench/campaign/reproduction_runs.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "analysis/reproduction/seeded_reproduction.hpp"
#include "analysis/study_files/resolved_study.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "bench/campaign/loop_farm.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/parts/part_folder.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"
#include "results/files/byte_stream.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kKeys = std::int64_t{1} << 60;

template <class Stream, class Numbers>
void transfer_numbers(Stream& stream, Numbers& numbers) {
  transfer_list(stream, numbers.rows, [&](auto& row) {
    transfer(stream, row.remark);
    transfer_list(stream, row.ours, [&](auto& number) { transfer(stream, number); });
  });
}

/// A table with one seed.
struct TableRun {
  ThesisTable table;
  std::uint64_t offset;
  std::int64_t key;
};

/// A key that stands for everything, besides program and solver, that the numbers of a table depend on.
std::int64_t key_of(const ThesisTable& table) {
  std::string text = table.name() + '\n';
  for (const auto& [variant, study] : table.studies)
    text += fmt::format("{}\n{}\n{}\n", variant, study.seed, resolved_study(study));
  for (const TableRow& row : table.rows) {
    text += fmt::format("{}|{}|{}\n", row.variant, row.scenario, row.benchmark.value_or(row.variant));
    for (const TableCell& cell : row.cells)
      text += fmt::format("{}|{}|{}\n", cell.quantity, cell.cv, cell.mv);
  }
  constexpr int kHexadecimal = 16;
  return std::stoll(digest_of(text).substr(0, 12), nullptr, kHexadecimal);
}

std::vector<TableRun> runs_of(const TableRuns& runs) {
  std::vector<TableRun> list;
  for (int seed = 0; seed < runs.seeds; ++seed)
    for (const ThesisTable& table : runs.tables) {
      const auto offset = static_cast<std::uint64_t>(seed);
      ThesisTable seeded = with_seed_offset(table, offset);
      const std::int64_t key = key_of(seeded);
      list.push_back({std::move(seeded), offset, key});
    }
  return list;
}

ShardIdentity identity_of(const TableRuns& runs) {
  return {{"program", program_identity()}, {"solver", runs.run.solver}};
}

/// The folders of these tables: the common one, and those of the parts within it.
std::vector<fs::path> folders_of(const TableRuns& runs) {
  std::vector<fs::path> folders{*runs.folder};
  std::error_code no_folder;
  for (const fs::directory_entry& entry : fs::directory_iterator(*runs.folder, no_folder))
    if (entry.is_directory(no_folder))
      folders.push_back(entry.path());
  return folders;
}

ShardStore opened_tables(const TableRuns& runs) {
  if (!runs.folder)
    return ShardStore(identity_of(runs));
  make_output_folder(*runs.folder, "tables");
  const fs::path own = runs.part ? *runs.folder / part_name("", runs.part) : *runs.folder;
  ShardStore store(own, identity_of(runs), {Leftovers::renew, 0.0, runs.warn});  // a shard a table
  for (const fs::path& folder : folders_of(runs))
    try {
      if (folder != own)
        store.take_stock(shards_in(folder), runs.warn);
    } catch (const OtherRun&) {
      continue;
    }
  return store;
}

/// The basis cases for each seed, which tables with the same study share. Drops those of earlier seeds when
/// no table needs them any more.
class SeededBasisCases {
 public:
  explicit SeededBasisCases(QpSolverFactory factory) : factory_(std::move(factory)) {}

  std::shared_ptr<BasisCases> of(std::uint64_t offset) {
    const std::lock_guard alone(mutex_);
    std::shared_ptr<BasisCases>& cases = cases_[offset];
    if (!cases) {
      cases = std::make_shared<BasisCases>(factory_);
      std::erase_if(cases_,
                    [&](const auto& other) { return other.first < offset && other.second.use_count() == 1; });
    }
    return cases_[offset];
  }

 private:
  QpSolverFactory factory_;
  std::mutex mutex_;
  std::map<std::uint64_t, std::shared_ptr<BasisCases>> cases_;
};

std::map<std::int64_t, TableNumbers> numbers_in(const ShardStore& store) {
  std::map<std::int64_t, TableNumbers> numbers;
  const ShardStore::Next next = store.in_order(0, kKeys);
  while (const ShardStore::Entry* const entry = next()) {
    ByteReader reader(entry->bytes);
    transfer_numbers(reader, numbers[entry->key]);
  }
  return numbers;
}

}  // namespace

std::vector<std::vector<ReproducedTable>> run_tables(const TableRuns& runs) {
  std::vector<TableRun> list = runs_of(runs);
  std::vector<std::int64_t> wanted;
  std::map<std::int64_t, const TableRun*> by_key;
  for (std::size_t place = 0; place < list.size(); ++place) {
    by_key.emplace(list[place].key, &list[place]);
    if (is_in_part(place, runs.part))
      wanted.push_back(list[place].key);
  }
  const QpSolverFactory factory = qp_solver_factory(runs.run.solver);
  SeededBasisCases basis_cases(factory);
  LoopWork::Thread run_table = [&](std::int64_t key) -> LoopResult {
    const TableRun& run = *by_key.at(key);
    const TableNumbers numbers = table_numbers(run.table, factory, *basis_cases.of(run.offset));
    ByteWriter writer;
    transfer_numbers(writer, numbers);
    return {.bytes = writer.take()};
  };
  ShardStore store = opened_tables(runs);
  run_missing(store, wanted,
              {.jobs = runs.run.solver == "active-set" ? runs.run.jobs : 1,  // Ipopt has no threads
               .thread = [&] { return run_table; },
               .stop = runs.stop,
               .what = "tables",
               .on_start = runs.on_start,
               .on_done = runs.on_done});
  const std::map<std::int64_t, TableNumbers> numbers = numbers_in(store);
  std::vector<std::vector<ReproducedTable>> result(runs.tables.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto found = numbers.find(list[i].key);
    result[i % runs.tables.size()].push_back(found != numbers.end()
                                                 ? reproduced(std::move(list[i].table), found->second)
                                                 : ReproducedTable{std::move(list[i].table), {}});
  }
  return result;
}

void remove_kept(const TableRuns& runs) {
  if (!runs.folder)
    return;
  std::vector<std::int64_t> keys;
  for (const TableRun& run : runs_of(runs))
    keys.push_back(run.key);
  for (const fs::path& folder : folders_of(runs))
    try {
      ShardStore(folder, identity_of(runs), {}).remove(keys);
    } catch (const InputError&) {
      continue;  // shards of another program, or a run in progress
    }
  std::error_code stays;
  fs::remove(*runs.folder, stays);  // when nothing is left in it
}

}  // namespace mpm
