#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/assessment/method_rates.hpp"
#include "results/comparison.hpp"

namespace mpm {
namespace {

/// The rates of a method, in the order in which they are shown.
struct RateLine {
  const char* name;
  Rate MethodRates::*rate;
};

constexpr RateLine kRates[] = {
    {"answered", &MethodRates::answered},
    {"detected", &MethodRates::detected},
    {"detected, with impact", &MethodRates::detected_impact},
    {"false alarms, healthy", &MethodRates::false_alarm_healthy},
    {"false alarms, bad tuning", &MethodRates::false_alarm_tuning},
    {"CV located", &MethodRates::located},
    {"source right", &MethodRates::source},
    {"channel named", &MethodRates::channel},
};

std::string rate_text(const Rate& rate) {
  if (rate.total == 0)
    return "-";
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}] of {}", 100 * rate.value, 100 * rate.interval.lower,
                     100 * rate.interval.upper, rate.total);
}

std::string method_text(const MethodRates& method) {
  std::string text = method.method + "\n";
  for (const RateLine& line : kRates)
    text += fmt::format("  {:<26} {}\n", line.name, rate_text(method.*line.rate));
  if (method.roc.defined())
    text += fmt::format("  {:<26} {:.3f} [{:.3f}, {:.3f}]\n", "area under ROC", method.roc.area,
                        method.roc_area.lower, method.roc_area.upper);
  if (!std::isnan(method.milliseconds))
    text += fmt::format("  {:<26} {:.2f} ms a loop\n", "processor time", method.milliseconds);
  if (!method.reason.empty())
    text += fmt::format("  {:<26} {}\n", "no verdict where", method.reason);
  return text;
}

}  // namespace

std::string comparison_text(const Campaign& campaign) {
  const ComparisonSummary summary = summarise(*campaign.comparison, campaign.records, campaign.study);
  std::string text = fmt::format("{}: {} loops\n\n", campaign.study.name, campaign.comparison->loops.size());
  for (const MethodRates& method : summary.methods)
    text += method_text(method) + "\n";
  for (const MethodPair& pair : summary.pairs)
    if (pair.loops > 0)
      text += fmt::format("{} against {}: right alone {} and {} of {}, p = {:.2g} (McNemar)\n",
                          summary.methods[pair.first].method, summary.methods[pair.second].method,
                          pair.test.lost, pair.test.gained, pair.loops, pair.test.p_two_sided);
  return text;
}

std::string comparison_json(const Campaign&) {
  return "{}\n";
}

}  // namespace mpm
