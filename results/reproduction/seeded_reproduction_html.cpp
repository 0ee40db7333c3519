#include <algorithm>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/html_page.hpp"
#include "results/report/html_table.hpp"
#include "results/reproduction/reproduction_parts.hpp"
#include "results/reproduction/seeded_reproduction.hpp"

namespace mpm {
namespace {

std::string cell_html(const SeededCell& cell) {
  std::string html = three_digits(cell.median, "&ndash;");
  if (cell.cell.thesis)
    html += fmt::format(" <small>({:g})</small>", *cell.cell.thesis);
  if (!cell.share)
    return wrapping(html);
  const std::string share = fmt::format("{:.0f} %", 100.0 * *cell.share);
  return wrapping(html + (*cell.share < 0.5 ? "<br><strong>" + share + "</strong>" : "<br>" + share));
}

std::string table_html(const SeededTable& table, std::size_t index) {
  std::vector<HtmlTable::Column> columns{{"", HtmlTable::Align::left}};
  for (const std::string& head : table.table.heads)
    columns.push_back({html_text(head), HtmlTable::Align::right});
  HtmlTable html(fmt::format("Median of ours over {} seeds, {}; the share of the seeds whose verdict agrees",
                             table.agreeing.size(), thesis_words(table.table)),
                 columns);
  for (const SeededRow& row : table.rows) {
    std::vector<std::string> cells{html_text(row.label + (row.remark.empty() ? "" : ": " + row.remark))};
    for (const SeededCell& cell : row.cells)
      cells.push_back(cell_html(cell));
    html.row(cells);
  }
  return table_section_html(table.table, html.html(), index);
}

std::string agreement_html(const std::vector<SeededTable>& tables) {
  HtmlTable html("Verdicts of the thesis that ours agree with, over the seeds",
                 {{"table", HtmlTable::Align::left}, {"mean"}, {"fewest"}, {"most"}, {"of"}});
  double agreeing = 0.0;
  int judged = 0;
  for (const SeededTable& table : tables) {
    const auto [least, most] = std::minmax_element(table.agreeing.begin(), table.agreeing.end());
    agreeing += table.mean_agreeing();
    judged += table.judged;
    html.row({fmt::format("<a href=\"#table-{}\">{}</a> {}", table.table.name(), table.table.label(),
                          html_text(table.table.title)),
              fmt::format("{:.1f}", table.mean_agreeing()), fmt::to_string(*least), fmt::to_string(*most),
              fmt::to_string(table.judged)});
  }
  html.row({"total", fmt::format("{:.1f}", agreeing), "", "", fmt::to_string(judged)});
  return html.html();
}

}  // namespace

std::string seeded_reproduction_html(const std::vector<SeededTable>& tables, const std::string& version,
                                     const std::vector<std::string>& changes) {
  std::string body = agreement_html(tables);
  for (std::size_t i = 0; i < tables.size(); ++i)
    body += table_html(tables[i], i + 1);
  return html_page({"the tables of the thesis", "The tables of the thesis over several seeds",
                    "<p>Botelho (UFRGS, 2015): ours beside the thesis's.</p>\n" + changes_html(changes),
                    "Made by <code>mpmbench reproduce</code>.", version},
                   body);
}

}  // namespace mpm
