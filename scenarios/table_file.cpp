#include "scenarios/table_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/error.hpp"
#include "scenarios/study_library.hpp"
#include "scenarios/study_variant.hpp"
#include "scenarios/toml_file.hpp"
#include "scenarios/toml_table.hpp"
#include "scenarios/toml_text.hpp"
#include "scenarios/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLastChapter = 6;

std::vector<std::string> cv_names(const Study& study) {
  std::vector<std::string> names;
  for (const PlantModel::Variable& cv : study.plant.cvs)
    names.push_back(cv.name);
  return names;
}

std::vector<std::string> mv_names(const Study& study) {
  std::vector<std::string> names;
  for (const PlantModel::Variable& mv : study.plant.mvs)
    names.push_back(mv.name);
  return names;
}

std::vector<std::string> quantity_names(const std::vector<TableQuantity>& quantities) {
  std::vector<std::string> names;
  for (const TableQuantity& quantity : quantities)
    names.push_back(quantity.name);
  return names;
}

std::vector<std::string> scenario_names(const Study& study) {
  std::vector<std::string> names;
  for (const Scenario& scenario : study.scenarios)
    names.push_back(scenario.name);
  return names;
}

/// What a column says of all its cells.
struct Column {
  std::string head, cv, mv, quantity;
};

std::vector<Column> read_columns(const TomlTable& document, const Study& study) {
  std::vector<Column> columns;
  for (const TomlTable& table : document.tables("column", {"head", "cv", "mv", "quantity"})) {
    Column column{read_text(table, "head"), "", "", read_text_or(table, "quantity", "")};
    if (table.has("cv"))
      column.cv = cv_names(study)[read_one_of(table, "cv", cv_names(study))];
    if (table.has("mv"))
      column.mv = mv_names(study)[read_one_of(table, "mv", mv_names(study))];
    columns.push_back(column);
  }
  return columns;
}

/// Keys that mean something for this kind of rule; others would be read over in silence.
void refuse_idle_keys(const TomlTable& table, RuleKind kind) {
  const bool banded = kind == RuleKind::outside || kind == RuleKind::any_within;
  for (const char* key : {"threshold", "band", "yes", "no"}) {
    const bool idle = key == std::string_view("threshold") ? kind != RuleKind::any_above
                      : key == std::string_view("band")    ? !banded
                                                           : kind == RuleKind::rank;
    if (idle && table.has(key))
      table.refuse(key, "a key that this kind of rule does not use", "none");
  }
}

VerdictRule read_rule(const TomlTable& table, const std::vector<TableQuantity>& quantities) {
  VerdictRule rule;
  for (const std::size_t quantity : read_some_of(table, "quantities", quantity_names(quantities)))
    rule.quantities.push_back(quantities[quantity].name);
  rule.kind = read_choice_or<RuleKind>(table, "kind",
                                       {{"outside", RuleKind::outside},
                                        {"any-above", RuleKind::any_above},
                                        {"any-within", RuleKind::any_within},
                                        {"rank", RuleKind::rank}},
                                       RuleKind::outside);
  refuse_idle_keys(table, rule.kind);
  if (rule.kind == RuleKind::any_above)
    rule.lower = read_number(table, "threshold", NumberRule::finite());
  if (rule.kind == RuleKind::outside || rule.kind == RuleKind::any_within) {
    table.require("band", "[low, high] with low < high");
    std::tie(rule.lower, rule.upper) = read_band_or(table, "band", NumberRule::finite(), {});
  }
  if (rule.kind != RuleKind::rank) {
    rule.yes = read_text(table, "yes");
    rule.no = read_text(table, "no");
  }
  rule.source = read_text(table, "source");
  return rule;
}

std::vector<VerdictRule> read_rules(const TomlTable& document, const std::vector<TableQuantity>& quantities) {
  std::vector<VerdictRule> rules;
  std::set<std::string> ruled;
  if (!document.has("rule"))
    return rules;
  for (const TomlTable& table :
       document.tables("rule", {"quantities", "kind", "threshold", "band", "yes", "no", "source"})) {
    rules.push_back(read_rule(table, quantities));
    for (const std::string& quantity : rules.back().quantities)
      if (!ruled.insert(quantity).second)
        table.refuse("quantities", in_quotes(quantity) + ", which has a rule already", "one rule a quantity");
  }
  return rules;
}

/// The verdicts of a row, in words; "" stands for a cell of which the thesis says nothing.
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

/// The numbers of a row; "" stands for a cell that the thesis leaves empty.
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

/// The quantity of a cell: that of its row, with '*' replaced by that of its column, or the only one given.
std::string joined_quantity(const std::string& of_row, const std::string& of_column) {
  const std::size_t star = of_row.find('*');
  if (star != std::string::npos)
    return std::string(of_row).replace(star, 1, of_column);
  return of_column.empty() ? of_row : of_column;
}

/// The one of `known` that the column names, or else the row under `key`.
std::string read_cell_name(const TomlTable& table, const char* key, const std::string& of_column,
                           const Column& column, const std::vector<std::string>& known) {
  const std::string name = of_column.empty() ? read_text_or(table, key, "") : of_column;
  if (name.empty())
    table.refuse("", fmt::format("no {} for column '{}'", key, column.head),
                 "one in the row or in the column");
  if (std::find(known.begin(), known.end(), name) == known.end())
    table.refuse(table.has(key) ? key : "",
                 fmt::format("{} {} in column '{}'", key, with_nearest(name, known), column.head),
                 fmt::format("{}", fmt::join(known, ", ")));
  return name;
}

/// Which cell it is that all its row and column say.
TableCell read_cell(const TomlTable& table, const Column& column, const Study& study,
                    const std::vector<TableQuantity>& quantities) {
  TableCell cell;
  cell.quantity =
      read_cell_name(table, "quantity", joined_quantity(read_text_or(table, "quantity", ""), column.quantity),
                     column, quantity_names(quantities));
  const auto quantity = std::find_if(quantities.begin(), quantities.end(),
                                     [&](const TableQuantity& q) { return q.name == cell.quantity; });
  if (quantity->scope != QuantityScope::loop)
    cell.cv = read_cell_name(table, "cv", column.cv, column, cv_names(study));
  if (quantity->scope == QuantityScope::channel)
    cell.mv = read_cell_name(table, "mv", column.mv, column, mv_names(study));
  return cell;
}

/// The variant under `key`, one of those that the file defines; empty: the study as it is.
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

/// What stands for the study as it is where a benchmark is named.
constexpr std::string_view kStudyItself = "study";

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

TableRow read_row(const TomlTable& table, const std::vector<Column>& columns,
                  const std::map<std::string, Study>& studies, const std::vector<TableQuantity>& quantities) {
  TableRow row;
  row.label = read_text(table, "label");
  row.variant = read_variant_name(table, "variant", studies);
  row.benchmark = read_benchmark(table, studies);
  const Study& study = studies.at(row.variant);
  row.scenario = read_scenario_name(table, study);
  for (const Column& column : columns)
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

std::map<std::string, Study> read_studies(const TomlTable& document, const TomlTable& heading,
                                          const fs::path& path) {
  std::map<std::string, Study> studies;
  const Study& base = studies.emplace("", read_base_study(heading, path.parent_path())).first->second;
  if (!document.has("variant"))
    return studies;
  const toml::table text = parse_toml(base.source, path.string());
  for (const TomlTable& table : document.tables("variant", {"name", "remove", "set"})) {
    const std::string name = read_name(table, "name");
    if (name == kStudyItself)
      table.refuse("name", in_quotes(name), "another name: it stands for the study as it is");
    if (!studies.emplace(name, read_study_variant(table, text, fmt::format("{} ({})", path.string(), name)))
             .second)
      table.refuse("name", in_quotes(name), "each name once");
  }
  return studies;
}

/// Table 3.10 comes after table 3.4, and the figures of a chapter after its tables.
std::tuple<int, bool, int> place_of(const ThesisTable& table) {
  return {table.chapter, table.figure, std::stoi(table.number.substr(table.number.find('.') + 1))};
}

std::vector<ThesisTable> all_tables(const std::vector<TableQuantity>& quantities, const fs::path& directory) {
  std::vector<ThesisTable> all;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".toml")
      all.push_back(load_table(entry->path(), quantities));
  if (error)
    throw InputError("folder of the tables", fmt::format("'{}' ({})", directory.string(), error.message()),
                     "a folder that can be read, beside that of the studies (MPMBENCH_STUDIES)");
  std::sort(all.begin(), all.end(),
            [](const ThesisTable& a, const ThesisTable& b) { return place_of(a) < place_of(b); });
  return all;
}

/// A verdict in words that no rule can come to would never agree.
void refuse_unknown_verdicts(const TomlTable& row, const ThesisTable& table) {
  for (const TableCell& cell : table.rows.back().cells) {
    if (!cell.verdict)
      continue;
    const VerdictRule* const rule = table.rule_for(cell.quantity);
    if (rule == nullptr)
      row.refuse("verdicts", in_quotes(*cell.verdict), "no verdict on a quantity without a rule");
    if (*cell.verdict != rule->yes && *cell.verdict != rule->no)
      row.refuse("verdicts", in_quotes(*cell.verdict), fmt::format("{} or {}", rule->yes, rule->no));
  }
}

}  // namespace

const VerdictRule* ThesisTable::rule_for(const std::string& quantity) const {
  for (const VerdictRule& rule : rules)
    if (std::find(rule.quantities.begin(), rule.quantities.end(), quantity) != rule.quantities.end())
      return &rule;
  return nullptr;
}

std::string ThesisTable::label() const {
  return fmt::format("{} {}", figure ? "Figure" : "Table", number);
}

std::string ThesisTable::name() const {
  return (figure ? "figure" : "") + number;
}

ThesisTable load_table(const fs::path& path, const std::vector<TableQuantity>& quantities) {
  const std::string file_name = path.string();
  const toml::table toml = parse_toml(read_toml_file(path, "a table file"), file_name);
  const TomlTable document(toml, file_name, {"table", "variant", "column", "rule", "row"});
  const TomlTable heading =
      document.table("table", {"chapter", "number", "figure", "title", "study", "note"});
  ThesisTable table;
  table.chapter = static_cast<int>(read_whole(heading, "chapter", 1, kLastChapter));
  table.figure = heading.has("figure");
  if (table.figure == heading.has("number"))
    heading.refuse("", table.figure ? "both number and figure" : "neither number nor figure",
                   "exactly one of the two");
  table.number =
      fmt::format("{}.{}", table.chapter, read_whole(heading, table.figure ? "figure" : "number", 1, 99));
  table.title = read_text(heading, "title");
  table.note = read_text_or(heading, "note", "");
  table.studies = read_studies(document, heading, path);
  const std::vector<Column> columns = read_columns(document, table.studies.at(""));
  for (const Column& column : columns)
    table.heads.push_back(column.head);
  table.rules = read_rules(document, quantities);
  for (const TomlTable& row : document.tables("row", {"label", "variant", "benchmark", "scenario", "cv", "mv",
                                                      "quantity", "values", "verdicts"})) {
    table.rows.push_back(read_row(row, columns, table.studies, quantities));
    refuse_unknown_verdicts(row, table);
  }
  return table;
}

fs::path table_directory() {
  return study_directory().parent_path() / "tables";
}

std::vector<ThesisTable> find_tables(const std::string& which, const std::vector<TableQuantity>& quantities,
                                     const fs::path& directory) {
  std::vector<ThesisTable> found;
  std::vector<std::string> known{"all"}, names;
  for (ThesisTable& table : all_tables(quantities, directory)) {
    const std::string chapter = fmt::format("chapter{}", table.chapter);
    if (known.back() != chapter)
      known.push_back(chapter);
    if (!names.empty() && names.back() == table.name())
      throw InputError(directory.string(), fmt::format("two files for {}", table.label()), "one");
    names.push_back(table.name());
    if (which == "all" || which == chapter || which == table.name())
      found.push_back(std::move(table));
  }
  known.insert(known.end(), names.begin(), names.end());
  if (found.empty())
    throw InputError("tables", with_nearest(which, known), fmt::format("{}", fmt::join(known, ", ")));
  return found;
}

}  // namespace mpm
