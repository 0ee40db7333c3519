#include "results/document/document_latex.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <fmt/format.h>

#include "results/document/words.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

/// Breaks a heading into two lines at the space nearest to its middle, so that the table fits a page:
/// "\shortstack[r]{Healthy,\\calibrated}"
std::string heading_latex(const std::string& heading) {
  std::size_t best = std::string::npos;
  const auto off = [&heading](std::size_t place) {
    return std::abs(2 * static_cast<std::int64_t>(place) - std::ssize(heading));
  };
  for (std::size_t space = heading.find(' '); space != std::string::npos;
       space = heading.find(' ', space + 1))
    if (best == std::string::npos || off(space) < off(best))
      best = space;
  if (best == std::string::npos)
    return words_latex(heading);
  return fmt::format("\\shortstack[r]{{{}\\\\{}}}", words_latex(heading.substr(0, best)),
                     words_latex(heading.substr(best + 1)));
}

std::string number_latex(const Number& number) {
  if (std::isnan(number.value))
    return "--";
  const bool in_percent = number.form != NumberForm::fixed && number.form != NumberForm::digits;
  const double unit = in_percent ? 100 : 1;
  const auto [lower, upper] = number.interval;
  const auto text = [&](double value) {
    return in_percent ? fmt::format("{:.{}f}", unit * value, number.form == NumberForm::whole_percent ? 0 : 1)
           : number.form == NumberForm::fixed ? fmt::format("{:.3f}", value)
                                              : fmt::format("{:.3g}", value);
  };
  return text(number.value) + (std::isnan(lower) ? "" : fmt::format(" ({}--{})", text(lower), text(upper)));
}

/// Returns a mark as superscript. A note in the comment of the table explains it.
std::string mark_latex(std::string_view mark) {
  std::string text;
  for (const char each : mark)
    text += each == '~' ? "$^\\sim$" : fmt::format("$^{}$", each);
  return text;
}

std::string cell_latex(const Cell& cell) {
  const Number* const number = std::get_if<Number>(&cell.content);
  const std::string text =
      number != nullptr ? number_latex(*number) : words_latex(std::get<std::string>(cell.content));
  return (cell.tone == Cell::Tone::strong ? fmt::format("\\textbf{{{}}}", text) : text) +
         mark_latex(cell.mark);
}

}  // namespace

std::string words_latex(std::string_view words) {
  std::string escaped;
  for (const char letter : shown_text(words_text(words)))
    switch (letter) {
      case '\\':
        escaped += "\\textbackslash{}";
        break;
      case '^':
        escaped += "\\textasciicircum{}";
        break;
      case '~':
        escaped += "\\textasciitilde{}";
        break;
      default:
        if (std::string_view("&%$#_{}").find(letter) != std::string_view::npos)
          escaped += '\\';
        escaped += letter;
    }
  return escaped;
}

std::string table_latex(const Table& table, std::string_view comment) {
  std::string text;
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    text += fmt::format("% {}\n", words_latex(comment.substr(begin, end - begin)));
    begin = end + 1;
  }
  text +=
      "% \\usepackage{booktabs}\n\\begingroup\\small\\setlength{\\tabcolsep}{3pt}% fits the text of "
      "article\n\\begin{tabular}{";
  for (const Table::Column& column : table.columns)
    text += column.align == Table::Align::right ? 'r' : 'l';
  text += "}\n\\toprule\n";
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += i == 0 ? words_latex(table.columns[i].title) : " & " + heading_latex(table.columns[i].title);
  text += " \\\\\n\\midrule\n";
  for (const Table::Row& row : table.rows) {
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      text += (i == 0 ? "" : " & ") + cell_latex(row.cells[i]);
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\\endgroup\n";
}

}  // namespace mpm
