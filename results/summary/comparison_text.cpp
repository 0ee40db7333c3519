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

std::string area_text(const MethodFindings& method) {
  const RocCurve& roc = method.rates.roc;
  if (!roc.defined())
    return "-";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}] {:>4}", roc.area, method.rates.roc_area.lower,
                     method.rates.roc_area.upper, roc.positives + roc.negatives);
}

std::string cost_text(const MethodFindings& method) {
  return std::isnan(method.rates.milliseconds) ? "-" : fmt::format("{:.2f}", method.rates.milliseconds);
}

/// One column a method of [first, last), one row a rate.
std::string rates_text(const std::vector<MethodFindings>& methods, std::size_t first, std::size_t last) {
  TextTable table;
  const auto row = [&](const std::string& title, const auto& cell) {
    TextTable::Row cells{title};
    for (std::size_t m = first; m < last; ++m)
      cells.push_back(cell(methods[m]));
    table.add(std::move(cells));
  };
  row("% of loops", [](const MethodFindings& m) { return m.name(); });
  for (const MethodRateInfo& info : method_rate_infos())
    row(info.title, [&](const MethodFindings& m) { return rate_text(m.rates.*info.rate); });
  row("area under ROC", area_text);
  row("ms a loop, median", cost_text);
  return table.text();
}

/// The methods that gave no verdict on some loop, with the reason.
std::string reasons_text(const std::vector<MethodFindings>& methods) {
  TextTable table;
  for (const MethodFindings& method : methods)
    if (const MethodRates& rates = method.rates; !rates.reason.empty())
      table.add({method.name(), fmt::format("{}", rates.answered.total - rates.answered.hits),
                 "loops, the first because: " + rates.reason});
  const std::string rows = table.text(TextTable::LastColumn::words);
  return rows.empty() ? rows : fmt::format("\nno verdict on\n{}", rows);
}

std::string pairs_text(const StudyFindings& summary) {
  TextTable table;
  table.add({"pair", "truth", "loops", "right: first alone", "second alone", "p"});
  for (const MethodPair& pair : summary.pairs)
    if (pair.loops > 0)
      table.add(
          {fmt::format("{} / {}", summary.methods[pair.first].name(), summary.methods[pair.second].name()),
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

std::string comparison_text(const Campaign& campaign, const StudyFindings& findings) {
  std::string text = fmt::format("{}: {} of {} experiments compared; [{:g} % interval], loops looked at\n",
                                 campaign.study.name, assessed_loops(campaign), campaign.records.size(),
                                 100.0 * campaign.study.aggregate.confidence);
  for (std::size_t first = 0; first < findings.methods.size(); first += kMethodsAbreast)
    text += fmt::format("\n{}", rates_text(findings.methods, first,
                                           std::min(first + kMethodsAbreast, findings.methods.size())));
  return text + reasons_text(findings.methods) + pairs_text(findings);
}

}  // namespace mpm
