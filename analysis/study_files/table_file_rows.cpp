#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "analysis/study_files/table_file_parts.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

std::vector<std::string> scenario_names(const Study& study) {
  std::vector<std::string> names;
  for (const Scenario& scenario : study.scenarios)
    names.push_back(scenario.name);
  return names;
}

/// Reads the verdicts of a row, in words; "" stands for a cell about which the thesis says nothing.
std::vector<std::optional<std::string>> read_verdicts(const TomlTable& table, std::size_t count) {
  const toml::node& node = table.require("verdicts", fmt::format("a list of {} texts", count));
  const toml::array* const list = node.as_array();
  if (list == nullptr || list->size() != count)
    table.refuse("verdicts", describe(node), fmt::format("a list of {} texts", count));
  std::vector<std::optional<std::string>> verdicts;
  for (const toml::node& value : *list) {
    if (!value.is_string())
      table.refuse("verdicts", describe(value), "texts, \"\" for an empty cell");
    const std::string& text = **value.as_string();
    verdicts.push_back(text.empty() ? std::nullopt : std::optional(text));
  }
  return verdicts;
}

/// Reads the numbers of a row; "" stands for a cell that the thesis leaves empty.
std::vector<std::optional<double>> read_values(const TomlTable& table, std::size_t count) {
  const toml::node& node = table.require("values", fmt::format("a list of {} numbers", count));
  const toml::array* const list = node.as_array();
  if (list == nullptr || list->size() != count)
    table.refuse("values", describe(node), fmt::format("a list of {} numbers", count));
  std::vector<std::optional<double>> values;
  for (const toml::node& value : *list) {
    const std::optional<double> number = value.is_number() ? value.value<double>() : std::nullopt;
    const bool empty = value.is_string() && (**value.as_string()).empty();
    if (!empty && !(number && std::isfinite(*number)))
      table.refuse("values", describe(value), "finite numbers, or \"\" for an empty cell");
    values.push_back(number);
  }
  return values;
}

/// Returns the quantity of a cell: that of its row with '*' replaced by that of its column; without a '*',
/// that of its column, or else that of its row.
std::string joined_quantity(const std::string& of_row, const std::string& of_column) {
  const std::size_t star = of_row.find('*');
  if (star != std::string::npos)
    return std::string(of_row).replace(star, 1, of_column);
  return of_column.empty() ? of_row : of_column;
}

/// Returns the name that the column gives, or else the row under `key`. It must be one of `known`.
std::string read_cell_name(const TomlTable& table, const char* key, const std::string& of_column,
                           const TableColumn& column, const std::vector<std::string>& known) {
  std::string name = of_column.empty() ? read_text_or(table, key, "") : of_column;
  if (name.empty())
    table.refuse("", fmt::format("no {} for column '{}'", key, column.head),
                 "one in the row or in the column");
  if (std::find(known.begin(), known.end(), name) == known.end())
    table.refuse(table.has(key) ? key : "",
                 fmt::format("{} {} in column '{}'", key, with_nearest(name, known), column.head),
                 fmt::format("{}", fmt::join(known, ", ")));
  return name;
}

/// Reads from the row and the column which quantity, CV and MV a cell has.
TableCell read_cell(const TomlTable& table, const TableColumn& column, const Study& study,
                    const std::vector<TableQuantity>& quantities) {
  TableCell cell;
  cell.quantity =
      read_cell_name(table, "quantity", joined_quantity(read_text_or(table, "quantity", ""), column.quantity),
                     column, quantity_names(quantities));
  const auto quantity = std::find_if(quantities.begin(), quantities.end(),
                                     [&](const TableQuantity& q) { return q.name == cell.quantity; });
  if (quantity->scope != QuantityScope::loop)
    cell.cv = read_cell_name(table, "cv", column.cv, column, variable_names(study.plant.cvs));
  if (quantity->scope == QuantityScope::channel)
    cell.mv = read_cell_name(table, "mv", column.mv, column, variable_names(study.plant.mvs));
  return cell;
}

/// Reads the variant under `key`, which must be one that the file defines. Without the key, returns "": the
/// study as it is.
std::string read_variant_name(const TomlTable& table, std::string_view key,
                              const std::map<std::string, Study>& studies) {
  if (!table.has(key))
    return "";
  std::vector<std::string> names;
  for (const auto& [name, study] : studies)
    if (!name.empty())
      names.push_back(name);
  if (names.empty())
    table.refuse(key, "a variant", "none: the table defines no [[variant]]");
  return names[read_one_of(table, key, names)];
}

std::optional<std::string> read_benchmark(const TomlTable& table,
                                          const std::map<std::string, Study>& studies) {
  if (!table.has("benchmark"))
    return std::nullopt;
  if (read_text(table, "benchmark") == kStudyItself)
    return "";
  return read_variant_name(table, "benchmark", studies);
}

std::string read_scenario_name(const TomlTable& table, const Study& study) {
  if (!table.has("scenario"))
    return "";
  if (!study.names_scenarios())
    table.refuse("scenario", "a scenario",
                 fmt::format("none: the study '{}' names no scenarios", study.name));
  return scenario_names(study)[read_one_of(table, "scenario", scenario_names(study))];
}

TableRow read_row(const TomlTable& table, const std::vector<TableColumn>& columns,
                  const std::map<std::string, Study>& studies, const std::vector<TableQuantity>& quantities) {
  TableRow row;
  row.label = read_text(table, "label");
  row.variant = read_variant_name(table, "variant", studies);
  row.benchmark = read_benchmark(table, studies);
  const Study& study = studies.at(row.variant);
  row.scenario = read_scenario_name(table, study);
  for (const TableColumn& column : columns)
    row.cells.push_back(read_cell(table, column, study, quantities));
  if (table.has("values") == table.has("verdicts"))
    table.refuse("", table.has("values") ? "both values and verdicts" : "neither values nor verdicts",
                 "exactly one of the two");
  if (table.has("values")) {
    const std::vector<std::optional<double>> values = read_values(table, columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i)
      row.cells[i].thesis = values[i];
  } else {
    const std::vector<std::optional<std::string>> verdicts = read_verdicts(table, columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i)
      row.cells[i].verdict = verdicts[i];
  }
  return row;
}

/// Refuses a verdict in words that no rule can give, because it would never agree.
void refuse_unknown_verdicts(const TomlTable& table, const TableRow& row, const ThesisTable& of) {
  for (const TableCell& cell : row.cells) {
    if (!cell.verdict)
      continue;
    const VerdictRule* const rule = of.rule_for(cell.quantity);
    if (rule == nullptr)
      table.refuse("verdicts", in_quotes(*cell.verdict), "no verdict on a quantity without a rule");
    if (*cell.verdict != rule->yes && *cell.verdict != rule->no)
      table.refuse("verdicts", in_quotes(*cell.verdict), fmt::format("{} or {}", rule->yes, rule->no));
  }
}

}  // namespace

std::vector<std::string> quantity_names(const std::vector<TableQuantity>& quantities) {
  std::vector<std::string> names;
  for (const TableQuantity& quantity : quantities)
    names.push_back(quantity.name);
  return names;
}

std::vector<TableColumn> read_table_columns(const TomlTable& document, const Study& study) {
  std::vector<TableColumn> columns;
  for (const TomlTable& table : document.tables("column", {"head", "cv", "mv", "quantity"})) {
    TableColumn column{read_text(table, "head"), "", "", read_text_or(table, "quantity", "")};
    if (table.has("cv"))
      column.cv = variable_names(study.plant.cvs)[read_one_of(table, "cv", variable_names(study.plant.cvs))];
    if (table.has("mv"))
      column.mv = variable_names(study.plant.mvs)[read_one_of(table, "mv", variable_names(study.plant.mvs))];
    columns.push_back(column);
  }
  return columns;
}

std::vector<TableRow> read_table_rows(const TomlTable& document, const std::vector<TableColumn>& columns,
                                      const ThesisTable& table,
                                      const std::vector<TableQuantity>& quantities) {
  std::vector<TableRow> rows;
  for (const TomlTable& row : document.tables("row", {"label", "variant", "benchmark", "scenario", "cv", "mv",
                                                      "quantity", "values", "verdicts"})) {
    rows.push_back(read_row(row, columns, table.studies, quantities));
    refuse_unknown_verdicts(row, rows.back(), table);
  }
  return rows;
}

}  // namespace mpm
