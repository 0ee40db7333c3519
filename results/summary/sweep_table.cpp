#include "results/summary/sweep_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// The headline findings of the first study that was run: later ones have the same.
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

std::string title(const Finding& column) {
  const bool of_kind = column.kind && column.group == FindingGroup::kind;
  return fmt::format("{}{}{}{}", plain_label(column.label), of_kind ? " " : "",
                     of_kind ? kind_name(*column.kind) : "", column.is_share() ? ", %" : "");
}

std::string cell(const Finding& column, const std::vector<Finding>& findings) {
  const Finding* const found = find_finding(findings, column.name);
  if (found == nullptr || !std::isfinite(found->value))
    return "-";
  const auto [lower, upper] = found->interval;
  if (column.is_share())
    return fmt::format("{:.1f} ({:.0f} to {:.0f})", 100 * found->value, 100 * lower, 100 * upper);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", found->value, lower, upper);
}

/// Why studies could not be run.
std::string troubles(const std::vector<SweepRow>& rows) {
  std::string text;
  for (const SweepRow& row : rows)
    if (!row.trouble.empty())
      text += fmt::format("\nnot run: {}: {}\n",
                          row.choice.empty() ? "as shipped" : fmt::format("{} = {}", row.choice, row.value),
                          row.trouble);
  return text;
}

}  // namespace

std::string sweep_table(const std::vector<SweepRow>& rows) {
  const std::vector<Finding> columns = columns_of(rows);
  std::string head = "| choice | value |";
  std::string rule = "|---|---|";
  for (const Finding& column : columns) {
    head += fmt::format(" {} |", title(column));
    rule += "---|";
  }
  std::string text = head + '\n' + rule + '\n';
  const std::string* last_choice = nullptr;
  for (const SweepRow& row : rows) {
    const bool repeated = last_choice != nullptr && *last_choice == row.choice;
    const std::string choice = row.choice.empty() ? "as shipped" : repeated ? "" : row.choice;
    text += fmt::format("| {} | {}{} |", choice, row.value, row.healthy ? "" : " *");
    for (const Finding& column : columns)
      text += fmt::format(" {} |", cell(column, row.findings));
    text += '\n';
    last_choice = &row.choice;
  }
  return text + troubles(rows);
}

}  // namespace mpm
