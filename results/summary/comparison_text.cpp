#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "results/summary/comparison.hpp"
#include "results/text/text_table.hpp"

namespace mpm {
namespace {

/// Methods side by side that fit into a hundred columns of a terminal.
constexpr std::size_t kMethodsAbreast = 3;

std::string rate_text(const Rate& rate) {
  if (rate.total == 0)
    return "-";
  return fmt::format("{:.1f} [{:.1f}, {:.1f}] {:>4}", 100 * rate.value, 100 * rate.interval.lower,
                     100 * rate.interval.upper, rate.total);
}

std::string area_text(const MethodRates& method) {
  if (!method.roc.defined())
    return "-";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}] {:>4}", method.roc.area, method.roc_area.lower,
                     method.roc_area.upper, method.roc.positives + method.roc.negatives);
}

std::string cost_text(const MethodRates& method) {
  return std::isnan(method.milliseconds) ? "-" : fmt::format("{:.2f}", method.milliseconds);
}

/// One column a method of [first, last), one row a rate.
std::string rates_text(const std::vector<MethodRates>& methods, std::size_t first, std::size_t last) {
  TextTable table;
  const auto row = [&](const std::string& title, const auto& cell) {
    TextTable::Row cells{title};
    for (std::size_t m = first; m < last; ++m)
      cells.push_back(cell(methods[m]));
    table.add(std::move(cells));
  };
  row("% of loops", [](const MethodRates& m) { return m.method; });
  for (const MethodRateInfo& info : method_rate_infos())
    row(info.title, [&](const MethodRates& m) { return rate_text(m.*info.rate); });
  row("area under ROC", area_text);
  row("ms a loop, median", cost_text);
  return table.text();
}

/// The methods that gave no verdict on some loop, with the reason.
std::string reasons_text(const std::vector<MethodRates>& methods) {
  TextTable table;
  for (const MethodRates& method : methods)
    if (!method.reason.empty())
      table.add({method.method, fmt::format("{}", method.answered.total - method.answered.hits),
                 "loops, the first because: " + method.reason});
  const std::string rows = table.text(TextTable::LastColumn::words);
  return rows.empty() ? rows : fmt::format("\nno verdict on\n{}", rows);
}

std::string pairs_text(const ComparisonSummary& summary) {
  TextTable table;
  table.add({"pair", "truth", "loops", "right: first alone", "second alone", "p"});
  for (const MethodPair& pair : summary.pairs)
    if (pair.loops > 0)
      table.add(
          {fmt::format("{} / {}", summary.methods[pair.first].method, summary.methods[pair.second].method),
           std::string(to_string(pair.truth)), fmt::format("{}", pair.loops),
           fmt::format("{}", pair.test.lost), fmt::format("{}", pair.test.gained),
           fmt::format("{:.2g}", pair.test.p_two_sided)});
  const bool none = std::none_of(summary.pairs.begin(), summary.pairs.end(),
                                 [](const MethodPair& pair) { return pair.loops > 0; });
  if (none)
    return "";
  return fmt::format(
      "\n{}(right: a loop with a fault, or with one that has an impact, is flagged and no other;\n"
      "p: McNemar's exact test, two-sided, over the loops that both gave a verdict on)\n",
      table.text());
}

}  // namespace

std::string comparison_text(const Campaign& campaign) {
  const ComparisonSummary summary = summarise(*campaign.comparison, campaign.records, campaign.study);
  std::string text = fmt::format("{}: {} of {} experiments compared; [{:g} % interval], loops looked at\n",
                                 campaign.study.name, campaign.comparison->loops.size(),
                                 campaign.records.size(), 100.0 * campaign.study.aggregate.confidence);
  for (std::size_t first = 0; first < summary.methods.size(); first += kMethodsAbreast)
    text += fmt::format("\n{}", rates_text(summary.methods, first,
                                           std::min(first + kMethodsAbreast, summary.methods.size())));
  return text + reasons_text(summary.methods) + pairs_text(summary);
}

}  // namespace mpm
