#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/study_files/thesis_table.hpp"

namespace mpm {

/// Reads a table file (docs/reproduction.md) whose cells may have `quantities`. Errors: InputError
/// "FILE:LINE: KEY: ...", also for a cell whose CV, scenario, variant or quantity there is not.
ThesisTable load_table(const std::filesystem::path& path, const std::vector<TableQuantity>& quantities);

/// Where the shipped tables are: the folder `tables` beside study_directory().
std::filesystem::path table_directory();

/// The tables in `directory`, in the order of their numbers, that match `which`: "all", "chapter4", or a
/// name. Errors: as load_table(); InputError when the folder cannot be read, when two files have one
/// number, and, with the known ones, when none matches.
std::vector<ThesisTable> find_tables(const std::string& which, const std::vector<TableQuantity>& quantities,
                                     const std::filesystem::path& directory = table_directory());

}  // namespace mpm
