#include "tests/scenarios/documented_keys.hpp"

#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include <catch2/catch.hpp>

namespace mpm::testing {
namespace {

using Keys = std::set<std::pair<std::string, std::string>>;  // table, key

Keys documented_keys(const std::string& document) {
  const std::regex heading("^## (`([^`]*)`|Top level).*");
  const std::regex other_heading("^## .*");
  const std::regex row("^\\| `([^`]*)` \\|.*");
  Keys keys;
  std::string table;
  bool of_table = false;
  std::istringstream lines(document);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, heading)) {
      of_table = true;
      table = match[2];
    } else if (std::regex_match(line, other_heading)) {
      of_table = false;
    } else if (of_table && std::regex_match(line, match, row)) {
      keys.emplace(table, match[1]);
    }
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
