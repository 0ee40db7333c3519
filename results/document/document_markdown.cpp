#include "results/document/document_markdown.hpp"

#include <cmath>

#include <fmt/format.h>

#include "results/document/words.hpp"

namespace mpm {
namespace {

std::string number_markdown(const Number& number) {
  if (!std::isfinite(number.value))
    return "-";
  const auto [lower, upper] = number.interval;
  if (number.form == NumberForm::share || number.form == NumberForm::percent)
    return fmt::format("{:.1f} ({:.0f} to {:.0f})", 100 * number.value, 100 * lower, 100 * upper);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", number.value, lower, upper);
}

std::string cell_markdown(const Cell& cell) {
  const Number* const number = std::get_if<Number>(&cell.content);
  return (number != nullptr ? number_markdown(*number) : words_text(std::get<std::string>(cell.content))) +
         cell.mark;
}

std::string table_markdown(const Table& table) {
  std::string head = "|", rule = "|", rows;
  for (const Table::Column& column : table.columns) {
    head += fmt::format(" {} |", words_text(column.title));
    rule += "---|";
  }
  for (const Table::Row& row : table.rows) {
    rows += "|";
    for (const Cell& cell : row.cells)
      rows += fmt::format(" {} |", cell_markdown(cell));
    rows += "\n";
  }
  return head + "\n" + rule + "\n" + rows;
}

}  // namespace

std::string document_markdown(const Document& document) {
  std::string text;
  for (const Section& section : document.sections)
    for (const auto& piece : section.content)
      if (const Table* const table = std::get_if<Table>(&piece))
        text += table_markdown(*table);
      else if (const Paragraph* const paragraph = std::get_if<Paragraph>(&piece))
        text += "\n" + words_text(paragraph->words) + "\n";
  return text;
}

}  // namespace mpm
