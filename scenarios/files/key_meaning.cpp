#include "scenarios/files/key_meaning.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"

namespace mpm {
namespace {

constexpr std::size_t kCommentWidth = 100;

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> pieces;
  for (;;) {
    const std::size_t end = text.find(separator);
    pieces.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos)
      return pieces;
    text.remove_prefix(end + separator.size());
  }
}

/// Without backquotes, and with the text of a link in its place.
std::string plain(std::string_view markdown) {
  std::string text;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    const std::size_t closed = markdown.find("](", i);
    if (markdown[i] == '[' && closed != std::string_view::npos && markdown.find('[', i + 1) > closed &&
        markdown.find(']', i) == closed) {
      text += plain(markdown.substr(i + 1, closed - i - 1));
      i = markdown.find(')', closed);
    } else if (markdown[i] != '`') {
      text += markdown[i];
    }
  }
  return text;
}

/// A row of a table without the bars at its ends. A bar in quotes has no blanks beside it.
std::vector<std::string> cells(std::string row) {
  for (std::size_t empty = row.find("| |"); empty != std::string::npos; empty = row.find("| |"))
    row.insert(empty + 1, 1, ' ');
  std::vector<std::string> cells = split(row.substr(2, row.rfind('|') - 2), " | ");
  for (std::string& cell : cells) {
    cell = plain(cell);
    cell.erase(0, cell.find_first_not_of(' '));
    cell.erase(cell.find_last_not_of(' ') + 1);
  }
  return cells;
}

using Meanings = std::map<std::pair<std::string, std::string>, KeyMeaning>;

/// The tables of the document stand under headings "## `NAME`", that of the top level under "## Top level".
Meanings read_meanings() {
  Meanings meanings;
  std::string table;
  std::vector<std::string> columns;
  std::istringstream lines{std::string(study_file_pages())};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## `"))
      table = line.substr(4, line.find('`', 4) - 4);
    else if (line.starts_with("## "))
      table.clear();
    else if (line.starts_with("| key "))
      columns = cells(line);
    else if (line.starts_with("| `")) {
      const std::vector<std::string> row = cells(line);
      KeyMeaning& meaning = meanings[{table, row.front()}];
      for (std::size_t i = 1; i < std::min(row.size(), columns.size()); ++i)
        (columns[i] == "unit"      ? meaning.unit
         : columns[i] == "default" ? meaning.fallback
         : columns[i] == "allowed" ? meaning.allowed
                                   : meaning.meaning) = columns[i] == "type" ? "" : row[i];
    }
  }
  return meanings;
}

std::string comment_of(const KeyMeaning& meaning) {
  std::string text = meaning.meaning;
  if (!meaning.unit.empty())
    text += fmt::format("{}[{}]", text.empty() ? "" : " ", meaning.unit);
  if (!meaning.allowed.empty())
    text += fmt::format("{}allowed: {}", text.empty() ? "" : "; ", meaning.allowed);
  std::string comment, line = "#";
  for (const std::string& word : split(text, " ")) {
    if (line.size() > 1 && line.size() + 1 + word.size() > kCommentWidth) {
      comment += line + '\n';
      line = "#";
    }
    line += ' ' + word;
  }
  return text.empty() ? "" : comment + line + '\n';
}

bool is_table_of(const std::string& name, const std::vector<std::string>& path) {
  const std::vector<std::string> parts = split(name, ".");
  if (parts.size() != path.size())
    return false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string part = parts[i].ends_with("[]") ? parts[i].substr(0, parts[i].size() - 2) : parts[i];
    if (part != "NAME" && part != path[i])
      return false;
  }
  return true;
}

/// The table of a path as it stands in a file: "controller.mv.u1" is "controller.mv.NAME", "plant.cv" a list
/// of tables. None for one that no study has.
std::optional<std::string> documented_table(const std::vector<std::string>& path) {
  if (path.empty())
    return "";
  for (const StudyFileTable& table : study_file_tables())
    if (is_table_of(table.name, path))
      return table.name;
  return std::nullopt;
}

}  // namespace

KeyMeaning key_meaning(std::string_view table, std::string_view key) {
  static const Meanings meanings = read_meanings();
  const auto found = meanings.find({std::string(table), std::string(key)});
  return found == meanings.end() ? KeyMeaning{} : found->second;
}

std::string commented_study(std::string_view text) {
  std::string commented;
  std::optional<std::string> table = "";
  std::set<std::pair<std::string, std::string>> said;
  const auto comment = [&](const std::optional<std::string>& of, const std::string& key) {
    if (of && said.emplace(*of, key).second)
      commented += comment_of(key_meaning(*of, key));
  };
  for (const std::string& line : split(text, "\n")) {
    if (line.starts_with("[")) {
      const std::size_t first = line.find_first_not_of('['), end = line.find(']');
      std::vector<std::string> path = split(std::string_view(line).substr(first, end - first), ".");
      table = documented_table(path);
      const std::string key = path.back();
      path.pop_back();
      comment(documented_table(path), key);
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      comment(table, line.substr(0, equals));
    }
    commented += line + '\n';
  }
  commented.pop_back();
  return commented;
}

}  // namespace mpm
