#include "analysis/study_files/table_file.hpp"

#include <algorithm>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/study_programs.hpp"
#include "analysis/study_files/study_variant.hpp"
#include "analysis/study_files/table_file_parts.hpp"
#include "base/error.hpp"
#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLastChapter = 7;

/// Reads the study of a variant: the study of the table with changes, or another study with or without
/// changes.
Study read_variant(const TomlTable& variant, const toml::table& base, const fs::path& path,
                   const std::string& name) {
  const std::string place = fmt::format("{} ({})", path.string(), name);
  if (!variant.has("study"))
    return read_study_variant(variant, base, place);
  toml::table text = parse_toml(read_base_study(variant, path.parent_path()).source, place);
  make_changes(text, variant);
  return study_of(text, place);
}

std::map<std::string, Study> read_studies(const TomlTable& document, const TomlTable& heading,
                                          const fs::path& path) {
  std::map<std::string, Study> studies;
  const Study& base = studies.emplace("", read_base_study(heading, path.parent_path())).first->second;
  if (!document.has("variant"))
    return studies;
  const toml::table text = parse_toml(base.source, path.string());
  for (const TomlTable& table : document.tables("variant", {"name", "study", "remove", "set"})) {
    const std::string name = read_name(table, "name");
    if (name == kStudyItself)
      table.refuse("name", in_quotes(name), "another name: this one stands for the study without changes");
    const auto [study, is_new] = studies.emplace(name, read_variant(table, text, path, name));
    if (!is_new)
      table.refuse("name", in_quotes(name), "each name once");
    trust_programs_of(study->second);
  }
  return studies;
}

/// Returns the sort key: table 3.10 comes after table 3.4, and the figures of a chapter after its tables.
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

}  // namespace

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
  table.rules = read_table_rules(document, quantities);
  const std::vector<TableColumn> columns = read_table_columns(document, table.studies.at(""));
  for (const TableColumn& column : columns)
    table.heads.push_back(column.head);
  table.rows = read_table_rows(document, columns, table, quantities);
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
