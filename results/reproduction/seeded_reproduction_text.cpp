#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/reproduction/reproduction_parts.hpp"
#include "results/reproduction/seeded_reproduction.hpp"

namespace mpm {
namespace {

using nlohmann::ordered_json;

std::string cell_text(const SeededCell& cell) {
  return fmt::format("{}{}{}", three_digits(cell.median, "-"),
                     cell.cell.thesis ? fmt::format(" ({:g})", *cell.cell.thesis) : "",
                     cell.share ? fmt::format(" {:>4.0f}%", 100.0 * *cell.share) : "");
}

std::string agreement_text(const SeededTable& table) {
  const auto [least, most] = std::minmax_element(table.agreeing.begin(), table.agreeing.end());
  return fmt::format("{:>5.1f} of {:>3} ({} to {})", table.mean_agreeing(), table.judged, *least, *most);
}

std::string table_text(const SeededTable& table) {
  std::vector<TextRow> rows;
  for (const SeededRow& row : table.rows) {
    rows.push_back({row.label, {}, row.remark});
    for (const SeededCell& cell : row.cells)
      rows.back().cells.push_back(cell_text(cell));
  }
  return table_rows_text(table.table, rows) + agreement_text(table) + " verdicts agree\n\n";
}

ordered_json cell_json(const SeededCell& cell, const std::string& head) {
  return {{"head", head},
          {"cv", cell.cell.cv},
          {"mv", cell.cell.mv},
          {"quantity", cell.cell.quantity},
          {"median", std::isfinite(cell.median) ? ordered_json(cell.median) : ordered_json(nullptr)},
          {"numbers", cell.numbers},
          {"thesis", or_null(cell.cell.thesis)},
          {"thesis_verdict", or_null(cell.thesis_verdict)},
          {"share", or_null(cell.share)}};
}

ordered_json table_json(const SeededTable& table) {
  ordered_json rows = ordered_json::array();
  for (const SeededRow& row : table.rows) {
    ordered_json cells = ordered_json::array();
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      cells.push_back(cell_json(row.cells[i], table.table.heads[i]));
    rows.push_back({{"label", row.label}, {"remark", row.remark}, {"cells", cells}});
  }
  return {{"number", table.table.number},
          {"figure", table.table.figure},
          {"title", table.table.title},
          {"note", table.table.note},
          {"judged", table.judged},
          {"agreeing", table.agreeing},
          {"rows", rows}};
}

}  // namespace

std::string seeded_reproduction_text(const std::vector<SeededTable>& tables,
                                     const std::vector<std::string>& changes) {
  std::string text = fmt::format(
      "{}In each cell the median of ours over {} seeds, the thesis's in brackets where it gives a number, "
      "and "
      "the share of\nthe seeds whose verdict agrees; below a table how many agree on average (fewest to "
      "most).\n\n",
      changes_text(changes), tables.front().agreeing.size());
  double agreeing = 0.0;
  int judged = 0;
  for (const SeededTable& table : tables) {
    text += table_text(table);
    agreeing += table.mean_agreeing();
    judged += table.judged;
  }
  for (const SeededTable& table : tables)
    text += fmt::format("{:<12} {}\n", table.table.label(), agreement_text(table));
  return text + fmt::format("{:<12} {:>5.1f} of {:>3} verdicts agree\n", "total", agreeing, judged);
}

std::string seeded_reproduction_json(const std::vector<SeededTable>& tables,
                                     const std::vector<std::string>& changes) {
  ordered_json list = ordered_json::array();
  double agreeing = 0.0;
  int judged = 0;
  for (const SeededTable& table : tables) {
    list.push_back(table_json(table));
    agreeing += table.mean_agreeing();
    judged += table.judged;
  }
  return ordered_json{{"set", changes},
                      {"seeds", tables.front().agreeing.size()},
                      {"tables", list},
                      {"judged", judged},
                      {"mean_agreeing", agreeing}}
             .dump(2) +
         "\n";
}

}  // namespace mpm
