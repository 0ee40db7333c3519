#include "results/document/document_text.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "results/document/words.hpp"

namespace mpm {
namespace {

std::string value_text(double value, NumberForm form) {
  if (std::isnan(value))
    return "-";
  switch (form) {
    case NumberForm::share:
    case NumberForm::percent:
      return fmt::format("{:.1f}", 100.0 * value);
    case NumberForm::whole_percent:
      return fmt::format("{:.0f}", 100.0 * value);
    case NumberForm::fixed:
      return fmt::format("{:.3f}", value);
    case NumberForm::digits:
      break;
  }
  return fmt::format("{:.3g}", value);
}

std::string cell_text(const Cell& cell) {
  const Number* const number = std::get_if<Number>(&cell.content);
  const std::string text =
      number != nullptr ? number_text(*number) : words_text(std::get<std::string>(cell.content));
  return text + cell.mark;
}

using TextRows = std::vector<std::vector<std::string>>;

/// Returns the width in characters, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::vector<std::size_t> widths_of(const TextRows& rows, std::size_t columns) {
  std::vector<std::size_t> widths(columns, 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; row.size() > 1 && i < row.size(); ++i)
      widths[i] = std::max(widths[i], width_of(row[i]));
  return widths;
}

std::string blanks(std::size_t width, const std::string& text) {
  return std::string(width - std::min(width, width_of(text)), ' ');
}

/// Writes the first column and those of [first, last), one line per row.
std::string block_text(const Table& table, const TextRows& rows, const std::vector<std::size_t>& widths,
                       std::size_t first, std::size_t last) {
  std::string text;
  for (const auto& row : rows) {
    std::string line = row.front() + blanks(widths.front(), row.front());
    for (std::size_t i = first; row.size() > 1 && i < last; ++i) {
      const std::string cell = i < row.size() ? row[i] : "";
      const std::string rest = blanks(widths[i], cell);
      line += "  " + (table.columns[i].align == Table::Align::right ? rest + cell : cell + rest);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

/// Returns the table without columns that only a page shows.
Table of_text(Table table) {
  for (std::size_t i = table.columns.size(); i-- > 0;) {
    if (table.columns[i].shown != Shown::page)
      continue;
    table.columns.erase(table.columns.begin() + static_cast<std::ptrdiff_t>(i));
    for (Table::Row& row : table.rows)
      if (!row.is_group && i < row.cells.size())
        row.cells.erase(row.cells.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return table;
}

std::string paragraph_text(const std::string& words, std::size_t width) {
  return wrapped(words_text(words), width);
}

struct PieceText {
  std::size_t width;

  std::string operator()(const Html&) const { return ""; }
  std::string operator()(const Figure&) const { return ""; }
  std::string operator()(const Table& table) const { return table_text(table, width); }
  std::string operator()(const Paragraph& paragraph) const { return paragraph_text(paragraph.words, width); }
  std::string operator()(const Facts& facts) const {
    constexpr std::size_t kUsualWidth = 14;
    std::size_t name_width = kUsualWidth;
    for (const Facts::Fact& fact : facts.list)
      name_width = std::max(name_width, words_text(fact.name).size() + 1);
    std::string text;
    for (const Facts::Fact& fact : facts.list) {
      const std::string value = words_text(fact.words + (fact.note.empty() ? "" : "; " + fact.note));
      std::string name = words_text(fact.name);
      std::istringstream lines(wrapped(value, width - name_width));
      for (std::string line; std::getline(lines, line); name.clear())
        text += fmt::format("{:<{}}{}\n", name, name_width, line);
    }
    return text;
  }
  std::string operator()(const Sentences& sentences) const {
    std::string text;
    for (const std::string& words : sentences.words)
      text += wrapped("- " + words_text(words), width, "  ");
    return text;
  }
};

}  // namespace

std::string wrapped(const std::string& sentence, std::size_t width, const std::string& set_in) {
  std::string text, line;
  std::istringstream words(sentence);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > width) {
      text += fmt::format("{}\n", line);
      line = set_in;
    }
    line += fmt::format("{}{}", line.empty() || line == set_in ? "" : " ", word);
  }
  return fmt::format("{}{}\n", text, line);
}

std::string number_text(const Number& number) {
  std::string text = value_text(number.value, number.form);
  if (!std::isnan(number.interval.lower))
    text += fmt::format(" [{}, {}]", value_text(number.interval.lower, number.form),
                        value_text(number.interval.upper, number.form));
  if (number.form == NumberForm::share && !std::isnan(number.value))
    text += " %";
  return number.of < 0 ? text : fmt::format("{} {:>4}", text, number.of);
}

std::string table_text(const Table& whole, std::size_t width) {
  const Table table = of_text(whole);
  const std::size_t columns = table.columns.size();
  TextRows rows{{}};
  for (const Table::Column& column : table.columns)
    rows.front().push_back(words_text(column.title));
  for (const Table::Row& row : table.rows) {
    std::vector<std::string>& cells = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(row.cells.size(), columns); ++i)
      cells.push_back(cell_text(row.cells[i]));
  }
  const std::vector<std::size_t> widths = widths_of(rows, columns);
  std::string text = table.caption.empty() ? "" : paragraph_text(table.caption, width);
  std::size_t first = std::min<std::size_t>(1, columns), last = first;
  do {
    std::size_t sum = std::min(widths.front(), width / 2);  // a wider one must not split the other columns
    for (; last < columns; ++last) {
      sum += 2 + widths[last];
      if (sum > width && last > first && table.columns[last].align != Table::Align::text)
        break;
    }
    text += (first > 1 ? "\n" : "") + block_text(table, rows, widths, first, last);
    first = last;
  } while (first < columns);
  return text;
}

std::string document_text(const Document& document, std::size_t width, bool full) {
  std::string text;
  bool is_whole = true;
  for (const std::string* words : {&document.heading, &document.lead})
    if (!words->empty())
      text += paragraph_text(*words, width);
  for (const Section& section : document.sections) {
    if (section.shown == Shown::page)
      continue;
    if (section.shown == Shown::full && !full) {
      is_whole = false;
      continue;
    }
    if (!section.title.empty())
      text += "\n" + paragraph_text(section.title, width);
    bool after_table = false;
    for (const auto& piece : section.content)
      if (const std::string part = std::visit(PieceText{width}, piece); !part.empty()) {
        const bool is_table = std::holds_alternative<Table>(piece);
        text += (is_table || after_table ? "\n" : "") + part;
        after_table = is_table;
      }
  }
  return is_whole ? text : text + "\nMore with --full.\n";
}

}  // namespace mpm
