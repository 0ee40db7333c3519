#include "results/summary/sweep_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace mpm {
namespace {

struct Column {
  const char* title;
  const char* name;  ///< of the aggregate
  bool share;
};

constexpr std::array<Column, 9> kColumns{{
    {"infeasible, %", "infeasible", true},
    {"located MPM, %", "mpm.located", true},
    {"located UD, %", "ud.located", true},
    {"located MPM+UD, %", "mpm_ud.located", true},
    {"MPM recognised, %", "mpm.source_recognised", true},
    {"UD recognised, %", "ud.source_recognised", true},
    {"R^2 MPM", "mpm.r_squared", false},
    {"R^2 UD", "ud.r_squared", false},
    {"R^2 MPM+UD", "mpm_ud.r_squared", false},
}};

std::string cell(const Column& column, const std::vector<AggregateValue>& values) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const AggregateValue& value) { return value.name == column.name; });
  if (found == values.end() || !std::isfinite(found->value))
    return "-";
  const auto [lower, upper] = found->interval;
  if (column.share)
    return fmt::format("{:.1f} ({:.0f} to {:.0f})", 100 * found->value, 100 * lower, 100 * upper);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", found->value, lower, upper);
}

}  // namespace

std::string sweep_table(const std::vector<SweepRow>& rows) {
  std::string head = "| choice | value |";
  std::string rule = "|---|---|";
  for (const Column& column : kColumns) {
    head += fmt::format(" {} |", column.title);
    rule += "---|";
  }
  std::string text = head + '\n' + rule + '\n';
  const std::string* last_choice = nullptr;
  for (const SweepRow& row : rows) {
    const bool repeated = last_choice != nullptr && *last_choice == row.choice;
    const std::string choice = row.choice.empty() ? "as shipped" : repeated ? "" : row.choice;
    text += fmt::format("| {} | {}{} |", choice, row.value, row.healthy ? "" : " *");
    for (const Column& column : kColumns)
      text += fmt::format(" {} |", cell(column, row.values));
    text += '\n';
    last_choice = &row.choice;
  }
  return text;
}

}  // namespace mpm
