#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include <catch2/catch.hpp>

#include "scenarios/study_file_keys.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using Keys = std::set<std::pair<std::string, std::string>>;  // table, key

/// The keys of docs/study_file.md: a heading "## `table`" (or "## Top level"), then table rows "| `key` |
/// ...".
Keys documented_keys() {
  const std::regex heading("^## (`([^`]*)`|Top level).*");
  const std::regex row("^\\| `([^`]*)` \\|.*");
  Keys keys;
  std::string table;
  std::istringstream document(testing::project_file("docs/study_file.md"));
  for (std::string line; std::getline(document, line);) {
    std::smatch match;
    if (std::regex_match(line, match, heading)) {
      table = match[2];
    } else if (std::regex_match(line, match, row)) {
      keys.emplace(table, match[1]);
    }
  }
  return keys;
}

Keys known_keys() {
  Keys keys;
  for (const StudyFileTable& table : study_file_tables()) {
    for (const std::string& key : table.keys) {
      keys.emplace(table.name, key);
    }
  }
  return keys;
}

TEST_CASE("the document of the study file has exactly the keys that the reader knows", "[study_file]") {
  const Keys documented = documented_keys();
  const Keys known = known_keys();
  for (const auto& [table, key] : known) {
    INFO("not in the document: " << table << " " << key);
    CHECK(documented.count({table, key}) == 1);
  }
  for (const auto& [table, key] : documented) {
    INFO("not known to the reader: " << table << " " << key);
    CHECK(known.count({table, key}) == 1);
  }
}

}  // namespace
}  // namespace mpm
