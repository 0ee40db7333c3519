#include "scenarios/table_file.hpp"

#include <algorithm>
#include <cmath>

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

std::vector<std::string> scenario_names(const Study& study) {
  std::vector<std::string> names;
  for (const Scenario& scenario : study.scenarios)
    names.push_back(scenario.name);
  return names;
}

/// What a column says of all its cells.
struct Column {
  std::string head, cv, quantity;
};

std::vector<Column> read_columns(const TomlTable& document, const Study& study) {
  std::vector<Column> columns;
  for (const TomlTable& table : document.tables("column", {"head", "cv", "quantity"})) {
    Column column{read_text(table, "head"), "", read_text_or(table, "quantity", "")};
    if (table.has("cv"))
      column.cv = cv_names(study)[read_one_of(table, "cv", cv_names(study))];
    columns.push_back(column);
  }
  return columns;
}

std::vector<std::string> read_texts(const TomlTable& table, const char* key) {
  const toml::node& node = table.require(key, "a list of texts");
  std::vector<std::string> texts;
  if (const toml::array* const list = node.as_array())
    for (const toml::node& text : *list)
      if (text.is_string())
        texts.push_back(**text.as_string());
  if (texts.empty() || texts.size() != node.as_array()->size())
    table.refuse(key, describe(node), "a list of texts");
  return texts;
}

VerdictRule read_rule(const TomlTable& table) {
  VerdictRule rule;
  rule.quantities = read_texts(table, "quantities");
  rule.kind = read_choice_or<RuleKind>(table, "kind",
                                       {{"outside", RuleKind::outside},
                                        {"any-above", RuleKind::any_above},
                                        {"any-within", RuleKind::any_within},
                                        {"rank", RuleKind::rank}},
                                       RuleKind::outside);
  if (rule.kind == RuleKind::any_above)
    rule.lower = read_number(table, "threshold", NumberRule::finite());
  if (rule.kind == RuleKind::outside || rule.kind == RuleKind::any_within)
    std::tie(rule.lower, rule.upper) = read_pair(table, "band", "[low, high]");
  if (rule.kind != RuleKind::rank) {
    rule.yes = read_text(table, "yes");
    rule.no = read_text(table, "no");
  }
  rule.source = read_text(table, "source");
  return rule;
}

/// The numbers of a row; "" stands for a cell that the thesis leaves empty.
std::vector<std::optional<double>> read_values(const TomlTable& table, std::size_t count) {
  const toml::node& node = table.require("values", fmt::format("a list of {} numbers", count));
  const toml::array* const list = node.as_array();
  if (list == nullptr || list->size() != count)
    table.refuse("values", describe(node), fmt::format("a list of {} numbers", count));
  std::vector<std::optional<double>> values;
  for (const toml::node& value : *list) {
    const std::optional<double> number = value.value<double>();
    if (!number && !(value.is_string() && (**value.as_string()).empty()))
      table.refuse("values", describe(value), "numbers, or \"\" for an empty cell");
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

TableRow read_row(const TomlTable& table, const std::vector<Column>& columns,
                  const std::map<std::string, Study>& studies) {
  TableRow row;
  row.label = read_text(table, "label");
  std::vector<std::string> variants;
  for (const auto& [name, study] : studies)
    variants.push_back(name);
  if (table.has("variant"))
    row.variant = variants[read_one_of(table, "variant", variants)];
  const Study& study = studies.at(row.variant);
  if (table.has("scenario"))
    row.scenario = scenario_names(study)[read_one_of(table, "scenario", scenario_names(study))];
  const std::string cv = table.has("cv") ? cv_names(study)[read_one_of(table, "cv", cv_names(study))] : "";
  const std::string quantity = read_text_or(table, "quantity", "");
  const std::vector<std::optional<double>> values = read_values(table, columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const TableCell cell{columns[i].cv.empty() ? cv : columns[i].cv,
                         joined_quantity(quantity, columns[i].quantity), values[i]};
    if (cell.cv.empty() || cell.quantity.empty())
      table.refuse("",
                   fmt::format("no {} for column '{}'", cell.cv.empty() ? "cv" : "quantity", columns[i].head),
                   "one in the row or in the column");
    row.cells.push_back(cell);
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
    if (!studies.emplace(name, read_study_variant(table, text, fmt::format("{} ({})", path.string(), name)))
             .second)
      table.refuse("name", in_quotes(name), "each name once");
  }
  return studies;
}

fs::path table_directory() {
  return study_directory().parent_path() / "tables";
}

/// "table-3.10.toml" after "table-3.4.toml".
std::pair<int, int> numbers_of(const ThesisTable& table) {
  return {table.chapter, std::stoi(table.number.substr(table.number.find('.') + 1))};
}

}  // namespace

const VerdictRule* ThesisTable::rule_for(const std::string& quantity) const {
  for (const VerdictRule& rule : rules)
    if (std::find(rule.quantities.begin(), rule.quantities.end(), quantity) != rule.quantities.end())
      return &rule;
  return nullptr;
}

ThesisTable load_table(const fs::path& path) {
  const std::string file_name = path.string();
  const toml::table toml = parse_toml(read_toml_file(path, "a table file"), file_name);
  const TomlTable document(toml, file_name, {"table", "variant", "column", "rule", "row"});
  const TomlTable heading = document.table("table", {"chapter", "number", "title", "study", "note"});
  ThesisTable table;
  table.chapter = static_cast<int>(read_whole(heading, "chapter", 1, kLastChapter));
  table.number = fmt::format("{}.{}", table.chapter, read_whole(heading, "number", 1, 99));
  table.title = read_text(heading, "title");
  table.note = read_text_or(heading, "note", "");
  table.studies = read_studies(document, heading, path);
  const std::vector<Column> columns = read_columns(document, table.studies.at(""));
  for (const Column& column : columns)
    table.heads.push_back(column.head);
  if (document.has("rule"))
    for (const TomlTable& rule :
         document.tables("rule", {"quantities", "kind", "threshold", "band", "yes", "no", "source"}))
      table.rules.push_back(read_rule(rule));
  for (const TomlTable& row :
       document.tables("row", {"label", "variant", "scenario", "cv", "quantity", "values"}))
    table.rows.push_back(read_row(row, columns, table.studies));
  return table;
}

std::vector<ThesisTable> find_tables(const std::string& which) {
  std::vector<ThesisTable> all;
  for (const fs::directory_entry& entry : fs::directory_iterator(table_directory()))
    if (entry.path().extension() == ".toml")
      all.push_back(load_table(entry.path()));
  std::sort(all.begin(), all.end(),
            [](const ThesisTable& a, const ThesisTable& b) { return numbers_of(a) < numbers_of(b); });
  std::vector<ThesisTable> found;
  std::vector<std::string> known{"all"};
  for (const ThesisTable& table : all) {
    const std::string chapter = fmt::format("chapter{}", table.chapter);
    if (which == "all" || which == chapter || which == table.number)
      found.push_back(table);
    if (std::find(known.begin(), known.end(), chapter) == known.end())
      known.push_back(chapter);
  }
  for (const ThesisTable& table : all)
    known.push_back(table.number);
  if (found.empty())
    throw InputError("tables", fmt::format("'{}'", which), fmt::format("{}", fmt::join(known, ", ")));
  return found;
}

}  // namespace mpm
