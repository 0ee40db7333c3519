#include "tests/scenarios/documented_keys.hpp"

#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <catch2/catch.hpp>

namespace mpm::testing {
namespace {

using Keys = std::set<std::pair<std::string, std::string>>;  // table, key

/// The text in backquotes that follows `begin` at the beginning of a line.
std::optional<std::string> quoted_after(const std::string& begin, const std::string& line) {
  if (!line.starts_with(begin + "`"))
    return std::nullopt;
  const std::size_t first = begin.size() + 1;
  return line.substr(first, line.find('`', first) - first);
}

Keys documented_keys(const std::string& document) {
  Keys keys;
  std::optional<std::string> table;
  std::istringstream lines(document);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## "))
      table = line.starts_with("## Top level") ? "" : quoted_after("## ", line);
    const std::optional<std::string> key = quoted_after("| ", line);
    if (table && key)
      keys.emplace(*table, *key);
  }
  return keys;
}

}  // namespace

void check_documented_keys(const std::string& document, const std::vector<StudyFileTable>& tables) {
  const Keys documented = documented_keys(document);
  Keys known;
  for (const StudyFileTable& table : tables)
    for (const std::string& key : table.keys)
      known.emplace(table.name, key);
  for (const auto& [table, key] : known) {
    INFO("not in the document: " << table << " " << key);
    CHECK(documented.count({table, key}) == 1);
  }
  for (const auto& [table, key] : documented) {
    INFO("not known to the reader: " << table << " " << key);
    CHECK(known.count({table, key}) == 1);
  }
}

}  // namespace mpm::testing
