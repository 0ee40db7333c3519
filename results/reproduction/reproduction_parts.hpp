#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenarios/files/table_file.hpp"

// What the tables of one run and of several seeds have in common as text and as HTML.

namespace mpm {

template <class Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// Three significant digits; `none` for NaN.
std::string three_digits(double value, const std::string& none);

/// A row as text: its label, its cells, and what is said behind them.
struct TextRow {
  std::string label;
  std::vector<std::string> cells;
  std::string remark;
};

/// Number, title, heads and rows of a table, in columns as wide as they have to be.
std::string table_rows_text(const ThesisTable& table, const std::vector<TextRow>& rows);

/// A cell of numbers and words that may be broken between them: a table of twelve CVs has to fit on a screen.
std::string wrapping(const std::string& html);

/// A section of a page: the title of the table, `html_table`, its rules and its note. `index` is its number
/// on the page.
std::string table_section_html(const ThesisTable& table, const std::string& html_table, std::size_t index);

/// What stands in the cells of a table beside ours: "the thesis's in brackets", or that it has no number.
std::string thesis_words(const ThesisTable& table);

/// "With A, B." and a blank line; nothing without changes.
std::string changes_text(const std::vector<std::string>& changes);
/// The same as a paragraph.
std::string changes_html(const std::vector<std::string>& changes);

}  // namespace mpm
