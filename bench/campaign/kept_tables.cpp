#include "bench/campaign/kept_tables.hpp"

#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/files/output_file.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/shards/shard_identity.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/byte_stream.hpp"
#include "results/files/file_seal.hpp"
#include "scenarios/files/resolved_study.hpp"

namespace mpm {
namespace {

template <class Stream, class Numbers>
void transfer_numbers(Stream& stream, Numbers& numbers) {
  transfer_list(stream, numbers.rows, [&](auto& row) {
    transfer(stream, row.remark);
    transfer_list(stream, row.ours, [&](auto& number) { transfer(stream, number); });
  });
}

bool fits(const TableNumbers& numbers, const ThesisTable& table) {
  if (numbers.rows.size() != table.rows.size())
    return false;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (numbers.rows[row].ours.size() != table.rows[row].cells.size())
      return false;
  return true;
}

}  // namespace

KeptTables::KeptTables(const std::filesystem::path& output, std::string solver)
    : folder_(output.string() + ".tables"), solver_(std::move(solver)), program_(program_identity()) {}

std::filesystem::path KeptTables::file_of(const ThesisTable& table, std::uint64_t offset) const {
  return folder_ / fmt::format("{}.seed{}", table.name(), offset);
}

std::string KeptTables::identity_of(const ThesisTable& table) const {
  std::string text;
  for (const auto& [variant, study] : table.studies)
    text += fmt::format("{}\n{}\n{}\n", variant, study.seed, resolved_study(study));
  for (const TableRow& row : table.rows) {
    text += fmt::format("{}|{}|{}\n", row.variant, row.scenario, row.benchmark.value_or(row.variant));
    for (const TableCell& cell : row.cells)
      text += fmt::format("{}|{}|{}\n", cell.quantity, cell.cv, cell.mv);
  }
  return fmt::format("{}, solver {}, table {}", program_, solver_, digest_of(text));
}

std::optional<TableNumbers> KeptTables::find(const ThesisTable& table, std::uint64_t offset) const {
  try {
    const std::vector<std::byte> bytes = read_sealed_file(file_of(table, offset));
    ByteReader reader(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::string identity;
    transfer(reader, identity);
    TableNumbers numbers;
    transfer_numbers(reader, numbers);
    reader.require_end();
    return identity == identity_of(table) && fits(numbers, table) ? std::optional(numbers) : std::nullopt;
  } catch (const std::runtime_error&) {  // ArchiveError too
    return std::nullopt;
  }
}

void KeptTables::keep(const ThesisTable& table, std::uint64_t offset, const TableNumbers& numbers) const {
  ByteWriter writer;
  const std::string identity = identity_of(table);
  transfer(writer, identity);
  transfer_numbers(writer, numbers);
  const std::string bytes = writer.take();
  const auto content = std::as_bytes(std::span(bytes));
  make_output_folder(folder_, "tables");
  write_file_atomically(file_of(table, offset), sealed({content.begin(), content.end()}));
}

void KeptTables::remove(const ThesisTable& table, std::uint64_t offset) const {
  const std::filesystem::path file = file_of(table, offset);
  std::error_code stays;  // what cannot be removed is found, or made anew, by another run
  remove_abandoned_files(file);
  std::filesystem::remove(file, stays);
  std::filesystem::remove(folder_, stays);  // when nothing is left in it
}

}  // namespace mpm
