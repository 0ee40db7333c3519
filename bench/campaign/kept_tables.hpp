#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "analysis/reproduction/table_reproduction.hpp"

namespace mpm {

/// The numbers of tables of the thesis that were run already, one file a table and seed, in a folder beside
/// the page that is made of them.
class KeptTables {
 public:
  /// Of the page `output`, with loops by this solver.
  KeptTables(const std::filesystem::path& output, std::string solver);

  /// Those of a table whose seeds were raised by `offset`; none when they are not there, damaged, or of
  /// another program, solver or table: they are made anew then.
  std::optional<TableNumbers> find(const ThesisTable& table, std::uint64_t offset) const;

  /// Makes the folder unless it is there. Throws ArchiveError.
  void keep(const ThesisTable& table, std::uint64_t offset, const TableNumbers& numbers) const;

  /// Removes those of a table and seed, which are on the page, and the folder with the last of them: numbers
  /// of other tables and seeds wait for another page.
  void remove(const ThesisTable& table, std::uint64_t offset) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path file_of(const ThesisTable& table, std::uint64_t offset) const;
  /// All that the numbers of a table depend on.
  std::string identity_of(const ThesisTable& table) const;

  std::filesystem::path folder_;
  std::string solver_, program_;
};

}  // namespace mpm
