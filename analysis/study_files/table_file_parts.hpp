#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/study_files/thesis_table.hpp"
#include "scenarios/toml/toml_table.hpp"

// The parts of the reader of table files, each in its own source file. All refuse wrong values as TomlTable
// does.

namespace mpm {

/// The name by which a row refers to the study without changes when it names a benchmark.
inline constexpr std::string_view kStudyItself = "study";

/// The values that a column gives to all its cells. If a value is empty, the row gives it.
struct TableColumn {
  std::string head, cv, mv, quantity;
};

/// [[rule]] (table_file_rules.cpp)
std::vector<VerdictRule> read_table_rules(const TomlTable& document,
                                          const std::vector<TableQuantity>& quantities);

/// [[column]] (table_file_rows.cpp)
std::vector<TableColumn> read_table_columns(const TomlTable& document, const Study& study);

/// [[row]] (table_file_rows.cpp); `table` has the studies and the rules.
std::vector<TableRow> read_table_rows(const TomlTable& document, const std::vector<TableColumn>& columns,
                                      const ThesisTable& table, const std::vector<TableQuantity>& quantities);

/// Returns the names of the quantities in their order.
std::vector<std::string> quantity_names(const std::vector<TableQuantity>& quantities);

}  // namespace mpm
