#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/html_page.hpp"
#include "results/report/html_table.hpp"
#include "results/reproduction/reproduction.hpp"
#include "results/reproduction/reproduction_parts.hpp"

namespace mpm {
namespace {

std::string cell_html(const ReproducedCell& cell) {
  std::string html = three_digits(cell.ours, "&ndash;");
  if (cell.cell.thesis)
    html += fmt::format(" <small>({:g})</small>", *cell.cell.thesis);
  if (cell.agrees() == false)
    html = fmt::format("<strong>{} &#10007;</strong><br><small>{}, thesis: {}</small>", html,
                       html_text(cell.our_verdict.value_or("no verdict")), html_text(*cell.thesis_verdict));
  return wrapping(html);
}

std::string table_html(const ReproducedTable& table, std::size_t index) {
  std::vector<HtmlTable::Column> columns{{"", HtmlTable::Align::left}};
  for (const std::string& head : table.table.heads)
    columns.push_back({html_text(head), HtmlTable::Align::right});
  const auto [agreeing, judged] = table.agreement();
  HtmlTable html(
      fmt::format("{} of {} verdicts agree; ours, {}", agreeing, judged, thesis_words(table.table)), columns);
  for (const ReproducedRow& row : table.rows) {
    std::vector<std::string> cells{html_text(row.label + (row.remark.empty() ? "" : ": " + row.remark))};
    for (const ReproducedCell& cell : row.cells)
      cells.push_back(cell_html(cell));
    html.row(cells);
  }
  return table_section_html(table.table, html.html(), index);
}

std::string agreement_html(const std::vector<ReproducedTable>& tables) {
  HtmlTable html("Verdicts of the thesis that ours agree with",
                 {{"table", HtmlTable::Align::left}, {"agree"}, {"of"}});
  Agreement total;
  for (const ReproducedTable& table : tables) {
    const auto [agreeing, judged] = table.agreement();
    total.add({agreeing, judged});
    html.row({fmt::format("<a href=\"#table-{}\">{}</a> {}", table.table.name(), table.table.label(),
                          html_text(table.table.title)),
              fmt::to_string(agreeing), fmt::to_string(judged)});
  }
  html.row({"total", fmt::to_string(total.agreeing), fmt::to_string(total.judged)});
  return html.html();
}

}  // namespace

std::string reproduction_html(const std::vector<ReproducedTable>& tables, const std::string& version,
                              const std::vector<std::string>& changes) {
  std::string body = agreement_html(tables);
  for (std::size_t i = 0; i < tables.size(); ++i)
    body += table_html(tables[i], i + 1);
  return html_page({"the tables of the thesis", "The tables of the thesis, cell by cell",
                    "<p>Botelho (UFRGS, 2015): ours beside the thesis's.</p>\n" + changes_html(changes),
                    "Made by <code>mpmbench reproduce</code>.", version},
                   body);
}

}  // namespace mpm
