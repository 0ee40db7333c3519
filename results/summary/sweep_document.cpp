#include "results/summary/sweep_document.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/files/utf8.hpp"
#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// Returns the headline findings of the first study that was run. Later studies have the same.
std::vector<Finding> columns_of(const std::vector<SweepRow>& rows) {
  std::vector<Finding> columns;
  const auto first =
      std::find_if(rows.begin(), rows.end(), [](const SweepRow& row) { return row.trouble.empty(); });
  if (first != rows.end())
    for (const Finding& finding : first->findings)
      if (finding.prominence == Prominence::headline)
        columns.push_back(finding);
  return columns;
}

std::string title_of(const Finding& column) {
  const bool of_kind = column.kind && column.group == FindingGroup::kind;
  return fmt::format("{}{}{}{}", column.label, of_kind ? " " : "", of_kind ? kind_name(*column.kind) : "",
                     column.is_share() ? ", %" : "");
}

Number number_in(const std::vector<Finding>& findings, const Finding& column) {
  const Finding* const found = find_finding(findings, column.name);
  return found == nullptr ? Number{}
                          : Number{found->value, column.is_share() ? NumberForm::percent : NumberForm::fixed,
                                   found->interval};
}

Table sweep_table(const std::vector<SweepRow>& rows) {
  const std::vector<Finding> columns = columns_of(rows);
  Table table("", {{"choice", Table::Align::left}, {"value", Table::Align::left}});
  for (const Finding& column : columns)
    table.columns.push_back({title_of(column)});
  const std::string* last_choice = nullptr;
  for (const SweepRow& row : rows) {
    const bool repeated = last_choice != nullptr && *last_choice == row.choice;
    last_choice = &row.choice;
    std::vector<Cell> cells{row.choice.empty() ? "as shipped"
                            : repeated         ? ""
                                               : as_label(row.choice),
                            as_label(row.value)};
    cells.back().mark = row.healthy ? "" : " *";
    for (const Finding& column : columns)
      cells.emplace_back(number_in(row.findings, column));
    table.row(std::move(cells));
  }
  return table;
}

nlohmann::ordered_json row_json(const SweepRow& row) {
  nlohmann::ordered_json findings = nlohmann::ordered_json::object();
  for (const Finding& finding : row.findings)
    findings[finding.name] = {{"value", finding.value},
                              {"lower", finding.interval.lower},
                              {"upper", finding.interval.upper},
                              {"count", finding.count}};
  return {{"choice", proper_utf8(row.choice)},
          {"value", proper_utf8(row.value)},
          {"healthy", row.healthy},
          {"trouble", proper_utf8(row.trouble)},
          {"findings", findings}};
}

}  // namespace

Document sweep_document(const std::string& title, const std::vector<SweepRow>& rows) {
  Section section{"sweep", ""};
  section.add(sweep_table(rows));
  for (const SweepRow& row : rows)
    if (!row.trouble.empty())
      section.say(as_label(fmt::format(
          "not run: {}: {}",
          row.choice.empty() ? "as shipped" : fmt::format("{} = {}", row.choice, row.value), row.trouble)));
  section.data = [title, &rows](nlohmann::ordered_json& json) {
    json["title"] = proper_utf8(title);
    json["studies"] = nlohmann::ordered_json::array();
    for (const SweepRow& row : rows)
      json["studies"].push_back(row_json(row));
  };
  return {.heading = as_label(title), .sections = {std::move(section)}};
}

}  // namespace mpm
