#include "results/document/document_markdown.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "results/document/words.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         static_cast<unsigned char>(c) >= 0x80;
}

/// Escapes words, so that Markdown shows them as they are. A '_' within a word and a '*' by itself need no
/// '\\'.
std::string words_markdown(std::string_view words) {
  const std::string text = shown_text(words_text(words));
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char before = i > 0 ? text[i - 1] : ' ', behind = i + 1 < text.size() ? text[i + 1] : ' ';
    const bool is_plain = (text[i] == '_' && is_letter_or_digit(before) && is_letter_or_digit(behind)) ||
                          (text[i] == '*' && before == ' ' && behind == ' ');
    if (!is_plain && std::string_view("\\`*_[]<>|&~$").find(text[i]) != std::string_view::npos)
      escaped += '\\';
    escaped += text[i];
  }
  return escaped;
}

std::string number_markdown(const Number& number) {
  if (!std::isfinite(number.value))
    return "-";
  const bool in_percent = number.form != NumberForm::fixed && number.form != NumberForm::digits;
  const double unit = in_percent ? 100.0 : 1.0;
  const int decimals = number.form == NumberForm::whole_percent ? 0 : in_percent ? 1 : 2;
  const auto [lower, upper] = number.interval;
  const std::string text = fmt::format("{:.{}f}", unit * number.value, decimals);
  return std::isnan(lower) ? text
                           : fmt::format("{} ({:.{}f} to {:.{}f})", text, unit * lower, in_percent ? 0 : 2,
                                         unit * upper, in_percent ? 0 : 2);
}

std::string cell_markdown(const Cell& cell) {
  const Number* const number = std::get_if<Number>(&cell.content);
  return (number != nullptr ? number_markdown(*number)
                            : words_markdown(std::get<std::string>(cell.content))) +
         cell.mark;
}

std::string table_markdown(const Table& table) {
  std::string head = "|", rule = "|", rows;
  for (const Table::Column& column : table.columns) {
    head += fmt::format(" {} |", words_markdown(column.title));
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
    for (const auto& piece : section.content) {
      std::string written;
      if (const Table* const table = std::get_if<Table>(&piece))
        written = table_markdown(*table);
      else if (const Paragraph* const paragraph = std::get_if<Paragraph>(&piece))
        written = words_markdown(paragraph->words) + "\n";
      else if (const Sentences* const sentences = std::get_if<Sentences>(&piece))
        for (const std::string& words : sentences->words)
          written += "- " + words_markdown(words) + "\n";
      text += (text.empty() || written.empty() ? "" : "\n") + written;
    }
  return text;
}

}  // namespace mpm
