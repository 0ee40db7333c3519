#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/toml/toml_literal.hpp"

namespace mpm {

/// One table of a TOML text that is being written, with its tables below it. Keys come out in the order given
/// when the table is made, whatever the order in which they are set.
class TomlDraft {
 public:
  explicit TomlDraft(std::vector<std::string> key_order) : key_order_(std::move(key_order)) {}

  /// Sets the value of a key of the order. The last value counts; it also replaces tables under this key.
  template <class Value>
  void set(std::string_view key, const Value& value) {
    entry(key).value = toml_literal(value);
  }
  /// Notes the default of a key, for lines().
  template <class Value>
  void set_default(std::string_view key, const Value& value) {
    entry(key).fallback = toml_literal(value);
  }
  /// A value with its path, "table.list[0].key"; `fallback` is empty for a key without a default.
  struct Line {
    std::string path, value, fallback;
  };
  /// All values, including the texts of comment(), in the order of text().
  std::vector<Line> lines() const;
  /// Has the meaning of each key written above it, on lines of its own; for several tables of one kind, above
  /// the first only. Returns this table.
  TomlDraft& explain(std::string_view kind, std::map<std::string, std::string> meanings);
  /// Writes "# KEY: TEXT" instead of a value that TOML cannot have. The text has no line break.
  void comment(std::string_view key, std::string_view text);
  /// The table under `key`, which is made if it is not there.
  TomlDraft& table(std::string_view key, const std::vector<std::string>& key_order);
  /// Entry `place` of the list of tables under `key`; entries are made one after the other.
  TomlDraft& table_in_list(std::string_view key, std::size_t place,
                           const std::vector<std::string>& key_order);

  /// The text of the whole document, when this is its outermost table: the values, one a line, then the
  /// tables under their headings. A table without values has no heading.
  std::string text() const;

 private:
  struct Entry {
    std::string value;     // empty: tables
    std::string fallback;  // empty: nothing was noted
    bool is_comment = false;
    bool is_list = false;
    std::vector<std::unique_ptr<TomlDraft>> tables;
  };

  Entry& entry(std::string_view key);
  using Explained = std::set<std::pair<std::string, std::string>>;  // kind of table, key
  void write(std::string& text, const std::string& path, Explained& explained) const;
  std::string explanation(const std::string& key, Explained& explained) const;
  void add_lines(std::vector<Line>& lines, const std::string& path) const;
  bool has_values() const;

  std::vector<std::string> key_order_;
  std::string kind_;
  std::map<std::string, std::string> meanings_;  ///< of keys; none: nothing is explained
  std::map<std::string, Entry, std::less<>> entries_;
};

}  // namespace mpm
