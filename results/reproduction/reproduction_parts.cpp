#include "results/reproduction/reproduction_parts.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

std::string rule_text(const VerdictRule& rule) {
  std::string quantities;
  for (const std::string& quantity : rule.quantities)
    quantities += (quantities.empty() ? "" : ", ") + quantity;
  switch (rule.kind) {
    case RuleKind::any_above:
      return fmt::format("{}: {} when some number of the row is above {:g}, else {}; {}", quantities,
                         rule.yes, rule.lower, rule.no, rule.source);
    case RuleKind::any_within:
      return fmt::format("{}: {} when some number of the row lies within {:g} to {:g}, else {}; {}",
                         quantities, rule.yes, rule.lower, rule.upper, rule.no, rule.source);
    case RuleKind::rank:
      return fmt::format("{}: the place in the column, from the smallest on; {}", quantities, rule.source);
    case RuleKind::outside:
      break;
  }
  return fmt::format("{}: {} outside of {:g} to {:g}, else {}; {}", quantities, rule.yes, rule.lower,
                     rule.upper, rule.no, rule.source);
}

}  // namespace

std::string thesis_words(const ThesisTable& table) {
  for (const TableRow& row : table.rows)
    for (const TableCell& cell : row.cells)
      if (cell.thesis)
        return "the thesis's in brackets";
  return "the thesis gives no numbers here, only verdicts";
}

std::string three_digits(double value, const std::string& none) {
  return std::isnan(value) ? none : fmt::format("{:.3g}", value);
}

std::string table_rows_text(const ThesisTable& table, const std::vector<TextRow>& rows) {
  std::size_t label_width = 0;
  for (const TextRow& row : rows)
    label_width = std::max(label_width, row.label.size());
  std::vector<std::size_t> widths;
  for (const std::string& head : table.heads)
    widths.push_back(head.size());
  for (const TextRow& row : rows)
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      widths[i] = std::max(widths[i], row.cells[i].size());

  std::string text = fmt::format("{}: {}\n{:<{}}", table.label(), table.title, "", label_width);
  for (std::size_t i = 0; i < widths.size(); ++i)
    text += fmt::format("  {:>{}}", table.heads[i], widths[i]);
  text += '\n';
  for (const TextRow& row : rows) {
    text += fmt::format("{:<{}}", row.label, label_width);
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += fmt::format("  {:>{}}", row.cells[i], widths[i]);
    text += row.remark.empty() ? "\n" : "  " + row.remark + "\n";
  }
  return text;
}

std::string wrapping(const std::string& html) {
  return fmt::format("<span class=\"wraps\">{}</span>", html);
}

std::string table_section_html(const ThesisTable& table, const std::string& html_table, std::size_t index) {
  std::string text;
  for (const VerdictRule& rule : table.rules)
    text += "<p>Verdict from " + html_text(rule_text(rule)) + ".</p>\n";
  if (!table.note.empty())
    text += "<p>" + html_text(table.note) + "</p>\n";
  return fmt::format(
      "<section id=\"table-{0}\" aria-labelledby=\"table-{0}-title\">\n<h2 id=\"table-{0}-title\"><span "
      "class=\"index\">{1}</span>{5}: {2}</h2>\n{3}{4}</section>\n",
      table.name(), index, html_text(table.title), html_table, text, table.label());
}

std::string changes_text(const std::vector<std::string>& changes) {
  return changes.empty() ? "" : fmt::format("With {}.\n\n", fmt::join(changes, ", "));
}

std::string changes_html(const std::vector<std::string>& changes) {
  std::string list;
  for (const std::string& change : changes)
    list += (list.empty() ? "" : ", ") + ("<code>" + html_text(change) + "</code>");
  return changes.empty() ? "" : "<p>With " + list + ".</p>\n";
}

}  // namespace mpm
