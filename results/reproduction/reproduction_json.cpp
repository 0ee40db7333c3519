#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "results/reproduction/reproduction.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

using nlohmann::ordered_json;

template <class Value>
ordered_json or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json numbers_json(const ReproducedCell& cell) {
  return {{"ours", finite_or_null(cell.ours)},
          {"thesis", or_null(cell.cell.thesis)},
          {"ratio", or_null(cell.ratio())},
          {"our_verdict", or_null(cell.our_verdict)},
          {"thesis_verdict", or_null(cell.thesis_verdict)},
          {"agrees", or_null(cell.agrees())}};
}

ordered_json numbers_json(const SeededCell& cell) {
  return {{"median", finite_or_null(cell.median)},
          {"numbers", cell.numbers},
          {"thesis", or_null(cell.cell.thesis)},
          {"thesis_verdict", or_null(cell.thesis_verdict)},
          {"share", or_null(cell.share)}};
}

ordered_json counts_json(const ReproducedTable& table) {
  const auto [agreeing, judged] = table.agreement();
  return {{"agreeing", agreeing}, {"judged", judged}};
}

ordered_json counts_json(const SeededTable& table) {
  return {{"judged", table.judged}, {"agreeing", table.agreeing}};
}

template <class AnyTable>
ordered_json tables_json(const std::vector<AnyTable>& tables) {
  ordered_json list = ordered_json::array();
  for (const AnyTable& table : tables) {
    ordered_json rows = ordered_json::array();
    for (const auto& row : table.rows) {
      ordered_json cells = ordered_json::array();
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const TableCell& cell = row.cells[i].cell;
        cells.push_back(
            {{"head", table.table.heads[i]}, {"cv", cell.cv}, {"mv", cell.mv}, {"quantity", cell.quantity}});
        cells.back().update(numbers_json(row.cells[i]));
      }
      rows.push_back({{"label", row.label}, {"remark", row.remark}, {"cells", cells}});
    }
    list.push_back({{"number", table.table.number},
                    {"figure", table.table.figure},
                    {"title", table.table.title},
                    {"note", table.table.note}});
    list.back().update(counts_json(table));
    list.back()["rows"] = rows;
  }
  return list;
}

}  // namespace

std::string reproduction_json(const std::vector<ReproducedTable>& tables,
                              const std::vector<std::string>& changes) {
  Agreement total;
  for (const ReproducedTable& table : tables)
    total.add(table.agreement());
  ordered_json json;
  if (!changes.empty())
    json["set"] = changes;
  json["tables"] = tables_json(tables);
  json["agreeing"] = total.agreeing;
  json["judged"] = total.judged;
  return json_text(json);
}

std::string reproduction_json(const std::vector<SeededTable>& tables,
                              const std::vector<std::string>& changes) {
  double agreeing = 0.0;
  int judged = 0;
  for (const SeededTable& table : tables) {
    agreeing += table.mean_agreeing();
    judged += table.judged;
  }
  const ordered_json json{{"set", changes},
                          {"seeds", tables.front().agreeing.size()},
                          {"tables", tables_json(tables)},
                          {"judged", judged},
                          {"mean_agreeing", agreeing}};
  return json_text(json);
}

}  // namespace mpm
