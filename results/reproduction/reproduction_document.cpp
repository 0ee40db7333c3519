#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/plot/plot_text.hpp"
#include "results/reproduction/reproduction.hpp"

namespace mpm {
namespace {

std::string rule_words(const VerdictRule& rule) {
  const std::string quantities = fmt::format("{}", fmt::join(rule.quantities, ", "));
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

std::string thesis_words(const ThesisTable& table) {
  for (const TableRow& row : table.rows)
    for (const TableCell& cell : row.cells)
      if (cell.thesis)
        return "the thesis's in brackets";
  return "the thesis gives no numbers here, only verdicts";
}

/// "1.23 (1.2)": our number, and the number of the thesis if it gives one.
Cell numbers_cell(double ours, const TableCell& cell) {
  return fmt::format("{}{}", std::isnan(ours) ? "-" : fmt::format("{:.3g}", ours),
                     cell.thesis ? fmt::format(" ({:g})", *cell.thesis) : "");
}

Cell cell_of(const ReproducedCell& cell) {
  Cell shown = numbers_cell(cell.ours, cell.cell);
  if (cell.agrees() == false) {
    shown.tone = Cell::Tone::strong;
    shown.mark = " x";
    shown.note = as_label(
        fmt::format("{}, thesis: {}", cell.our_verdict.value_or("no verdict"), *cell.thesis_verdict));
  }
  return shown;
}

Cell cell_of(const SeededCell& cell) {
  Cell shown = numbers_cell(cell.median, cell.cell);
  if (cell.share) {
    shown.mark = fmt::format(" {:.0f}%", 100.0 * *cell.share);
    shown.tone = *cell.share < 0.5 ? Cell::Tone::strong : Cell::Tone::plain;
  }
  return shown;
}

std::string caption_of(const ReproducedTable& table) {
  const auto [agreeing, judged] = table.agreement();
  return fmt::format("{} of {} verdicts agree; ours, {}", agreeing, judged, thesis_words(table.table));
}

std::string caption_of(const SeededTable& table) {
  const auto [least, most] = std::minmax_element(table.agreeing.begin(), table.agreeing.end());
  return fmt::format(
      "{:.1f} ({} to {}) of {} verdicts agree; median of ours over {} seeds, {}; the share of the seeds "
      "whose "
      "verdict agrees",
      table.mean_agreeing(), *least, *most, table.judged, table.agreeing.size(), thesis_words(table.table));
}

template <class AnyTable>
Section table_section(const AnyTable& of) {
  const ThesisTable& thesis = of.table;
  Section section{"table-" + thesis.name(), as_label(fmt::format("{}: {}", thesis.label(), thesis.title))};
  std::vector<Table::Column> columns{{"", Table::Align::left}};
  for (const std::string& head : thesis.heads)
    columns.push_back({as_label(head)});
  if (std::any_of(of.rows.begin(), of.rows.end(), [](const auto& row) { return !row.remark.empty(); }))
    columns.push_back({"", Table::Align::text});
  Table table(caption_of(of), std::move(columns));
  table.wraps = true;
  for (const auto& row : of.rows) {
    std::vector<Cell> cells{as_label(row.label)};
    for (const auto& cell : row.cells)
      cells.push_back(cell_of(cell));
    cells.resize(1 + thesis.heads.size(), Cell(""));
    cells.emplace_back(as_label(row.remark));
    table.row(std::move(cells));
  }
  section.add(std::move(table));
  for (const VerdictRule& rule : thesis.rules)
    section.say("Verdict from " + as_label(rule_words(rule)) + ".");
  if (!thesis.note.empty())
    section.say(as_label(thesis.note));
  return section;
}

std::string table_words(const ThesisTable& table) {
  return fmt::format("{} {}", link("table-" + table.name(), table.label()), as_label(table.title));
}

Table agreement_table(const std::vector<ReproducedTable>& tables) {
  Table table("Verdicts of the thesis with which ours agree", {{"", Table::Align::left}, {"agree"}, {"of"}});
  Agreement total;
  for (const ReproducedTable& each : tables) {
    total.add(each.agreement());
    table.row({table_words(each.table), each.agreement().agreeing, each.agreement().judged});
  }
  table.row({"total", total.agreeing, total.judged});
  return table;
}

Table agreement_table(const std::vector<SeededTable>& tables) {
  Table table("Verdicts of the thesis with which ours agree, over the seeds",
              {{"", Table::Align::left}, {"mean"}, {"fewest"}, {"most"}, {"of"}});
  double agreeing = 0.0;
  int judged = 0;
  for (const SeededTable& each : tables) {
    const auto [least, most] = std::minmax_element(each.agreeing.begin(), each.agreeing.end());
    agreeing += each.mean_agreeing();
    judged += each.judged;
    table.row(
        {table_words(each.table), fmt::format("{:.1f}", each.mean_agreeing()), *least, *most, each.judged});
  }
  table.row({"total", fmt::format("{:.1f}", agreeing), "", "", judged});
  return table;
}

template <class AnyTable>
Document document_of(const std::vector<AnyTable>& tables, const std::string& heading,
                     const std::string& version, const std::vector<std::string>& changes) {
  std::string with;
  for (const std::string& change : changes)
    with += (with.empty() ? " With " : ", ") + code(change);
  Document document{"the tables of the thesis", heading,
                    "Botelho (UFRGS, 2015): ours beside the thesis's; x where another verdict follows." +
                        with + (with.empty() ? "" : "."),
                    "Made by " + code("mpmbench reproduce") + ".", version};
  Section agreement{.id = "agreement", .title = "Agreement", .shown = Shown::page};
  agreement.add(agreement_table(tables));
  document.sections.push_back(agreement);
  for (const AnyTable& table : tables)
    document.sections.push_back(table_section(table));
  agreement.shown = Shown::text;  // last, because a text is read from its end
  document.sections.push_back(std::move(agreement));
  return document;
}

}  // namespace

Document reproduction_document(const std::vector<ReproducedTable>& tables, const std::string& version,
                               const std::vector<std::string>& changes) {
  return document_of(tables, "The tables of the thesis, cell by cell", version, changes);
}

Document reproduction_document(const std::vector<SeededTable>& tables, const std::string& version,
                               const std::vector<std::string>& changes) {
  return document_of(tables,
                     fmt::format("The tables of the thesis over {} seeds", tables.front().agreeing.size()),
                     version, changes);
}

}  // namespace mpm
