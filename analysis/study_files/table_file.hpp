#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/study_files/thesis_table.hpp"

namespace mpm {

/// Reads a table file (docs/reproduction.md) whose cells may have `quantities`. Errors: InputError
/// "FILE:LINE: KEY: ...", also for a cell with an unknown CV, scenario, variant or quantity.
ThesisTable load_table(const std::filesystem::path& path, const std::vector<TableQuantity>& quantities);

/// Returns the folder of the shipped tables: `tables` beside study_directory().
std::filesystem::path table_directory();

/// Returns the tables in `directory` that match `which` ("all", "chapter4", or a name), in the order of their
/// numbers. Errors: as load_table(); InputError if the folder cannot be read or two files have the same
/// number, and, listing the known names, if no table matches.
std::vector<ThesisTable> find_tables(const std::string& which, const std::vector<TableQuantity>& quantities,
                                     const std::filesystem::path& directory = table_directory());

}  // namespace mpm
