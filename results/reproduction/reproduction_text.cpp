#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/reproduction/reproduction.hpp"
#include "results/reproduction/reproduction_parts.hpp"

namespace mpm {
namespace {

using nlohmann::ordered_json;

std::string cell_text(const ReproducedCell& cell) {
  return fmt::format("{}{}{}", three_digits(cell.ours, "-"),
                     cell.cell.thesis ? fmt::format(" ({:g})", *cell.cell.thesis) : "",
                     cell.agrees() == false ? " x" : "  ");
}

std::string table_text(const ReproducedTable& table) {
  std::vector<TextRow> rows;
  for (const ReproducedRow& row : table.rows) {
    rows.push_back({row.label, {}, row.remark});
    for (const ReproducedCell& cell : row.cells)
      rows.back().cells.push_back(cell_text(cell));
  }
  const auto [agreeing, judged] = table.agreement();
  return table_rows_text(table.table, rows) + fmt::format("{} of {} verdicts agree\n\n", agreeing, judged);
}

ordered_json cell_json(const ReproducedCell& cell, const std::string& head) {
  return {{"head", head},
          {"cv", cell.cell.cv},
          {"mv", cell.cell.mv},
          {"quantity", cell.cell.quantity},
          {"ours", std::isfinite(cell.ours) ? ordered_json(cell.ours) : ordered_json(nullptr)},
          {"thesis", or_null(cell.cell.thesis)},
          {"ratio", or_null(cell.ratio())},
          {"our_verdict", or_null(cell.our_verdict)},
          {"thesis_verdict", or_null(cell.thesis_verdict)},
          {"agrees", or_null(cell.agrees())}};
}

ordered_json table_json(const ReproducedTable& table) {
  ordered_json rows = ordered_json::array();
  for (const ReproducedRow& row : table.rows) {
    ordered_json cells = ordered_json::array();
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      cells.push_back(cell_json(row.cells[i], table.table.heads[i]));
    rows.push_back({{"label", row.label}, {"remark", row.remark}, {"cells", cells}});
  }
  const auto [agreeing, judged] = table.agreement();
  return {{"number", table.table.number},
          {"figure", table.table.figure},
          {"title", table.table.title},
          {"note", table.table.note},
          {"agreeing", agreeing},
          {"judged", judged},
          {"rows", rows}};
}

}  // namespace

std::string reproduction_text(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes) {
  std::string text = changes_text(changes) +
                     "In each cell ours, the thesis's in brackets where it gives a number, x where another "
                     "verdict follows.\n\n";
  Agreement total;
  for (const ReproducedTable& table : tables) {
    text += table_text(table);
    total.add(table.agreement());
  }
  for (const ReproducedTable& table : tables) {
    const auto [agreeing, judged] = table.agreement();
    text += fmt::format("{:<12} {:>3} of {:>3}\n", table.table.label(), agreeing, judged);
  }
  return text + fmt::format("{:<12} {:>3} of {:>3} verdicts agree\n", "total", total.agreeing, total.judged);
}

std::string reproduction_json(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes) {
  ordered_json list = ordered_json::array();
  Agreement total;
  for (const ReproducedTable& table : tables) {
    list.push_back(table_json(table));
    total.add(table.agreement());
  }
  ordered_json json;
  if (!changes.empty())
    json["set"] = changes;
  json["tables"] = list;
  json["agreeing"] = total.agreeing;
  json["judged"] = total.judged;
  return json.dump(2) + "\n";
}

}  // namespace mpm
