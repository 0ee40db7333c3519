#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/method_rates.hpp"
#include "results/summary/comparison.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/text_table.hpp"

namespace mpm {
namespace {

/// Methods side by side that fit into a hundred columns of a terminal.
constexpr std::size_t kMethodsAbreast = 3;
constexpr std::size_t kLineWidth = 100;

std::string rate_text(const Rate& rate) {
  if (rate.total == 0)
    return "-";
  return fmt::format("{:.1f} [{:.1f}, {:.1f}] {:>4}", 100 * rate.value, 100 * rate.interval.lower,
                     100 * rate.interval.upper, rate.total);
}

std::string estimate_text(const Estimate& estimate) {
  if (estimate.count == 0)
    return "-";
  const Interval& interval = estimate.interval;
  return std::isnan(interval.lower) ? fmt::format("{:.3g} {:>4}", estimate.value, estimate.count)
                                    : fmt::format("{:.3g} [{:.3g}, {:.3g}] {:>4}", estimate.value,
                                                  interval.lower, interval.upper, estimate.count);
}

std::string area_text(const RocCurve& roc, const Interval& area) {
  if (!roc.defined())
    return "-";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}] {:>4}", roc.area, area.lower, area.upper,
                     roc.positives + roc.negatives);
}

/// The share of healthy loops that the method says it flags, and a mark when it does not.
std::string stated_text(const MethodFindings& method) {
  const MethodDescription& description = method.form->method();
  const FalseAlarmMark mark = false_alarm_mark(description, method.rates);
  const std::string stated = description.stated_false_alarms
                                 ? fmt::format("{:.1f}", 100 * *description.stated_false_alarms)
                                 : "none";
  return mark == FalseAlarmMark::none ? stated : fmt::format("{} ({} found) !", stated, to_string(mark));
}

std::string cost_text(const MethodFindings& method) {
  return std::isnan(method.rates.milliseconds) ? "-" : fmt::format("{:.2f}", method.rates.milliseconds);
}

/// One column a method of [first, last), one row a rate.
std::string rates_text(const Study& study, const std::vector<MethodFindings>& methods, std::size_t first,
                       std::size_t last) {
  TextTable table;
  const auto row = [&](const std::string& title, const auto& cell) {
    TextTable::Row cells{title};
    for (std::size_t m = first; m < last; ++m)
      cells.push_back(cell(methods[m]));
    table.add(std::move(cells));
  };
  row("% of loops", [](const MethodFindings& m) { return m.name(); });
  for (const MethodRateInfo& info : method_rate_infos(study))
    row(info.title, [&](const MethodFindings& m) { return rate_text(m.rates.*info.rate); });
  row("false alarms stated", stated_text);
  row("area under ROC, fault",
      [](const MethodFindings& m) { return area_text(m.rates.roc, m.rates.roc_area); });
  row("area under ROC, impact",
      [](const MethodFindings& m) { return area_text(m.rates.roc_impact, m.rates.roc_impact_area); });
  for (const MethodEstimateInfo& info : method_estimate_infos())
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const MethodFindings& m) { return (m.rates.*info.estimate).count > 0; }))
      row(info.title, [&](const MethodFindings& m) { return estimate_text(m.rates.*info.estimate); });
  row("ms a loop, median", cost_text);
  return table.text();
}

/// What the marks of stated_text() mean, when there are any.
std::string marks_text(const StudyFindings& findings) {
  const bool none = std::all_of(findings.methods.begin(), findings.methods.end(), [](const auto& method) {
    return false_alarm_mark(method.form->method(), method.rates) == FalseAlarmMark::none;
  });
  return none ? ""
              : fmt::format(
                    "\n!: the interval of the false alarms on healthy loops does not hold the rate that the "
                    "method\nstates, or {:g} % where it states none\n",
                    100.0 * kUsualFalseAlarms);
}

/// On what the thresholds were calibrated, and where the loops were too few.
std::string calibration_text(const Campaign& campaign, const StudyFindings& findings) {
  if (!campaign.study.calibration)
    return "";
  const CalibrationOptions& options = *campaign.study.calibration;
  std::string text = fmt::format(
      "\ncalibrated: thresholds on {} healthy loops and {} with a disturbance of seed {};\n\"calibrated: "
      "false "
      "alarms\" at a threshold for {:g} %\n",
      options.healthy, options.ud, campaign.calibration.seed, 100.0 * options.false_alarms);
  for (const MethodFindings& method : findings.methods)
    for (const ThresholdInfo& info : threshold_infos())
      if (const CalibratedThreshold& threshold = method.rates.thresholds.*info.threshold;
          !threshold.value && threshold.loops > 0)
        text += fmt::format("no {} of {}: {} calibration loops with a verdict are too few\n", info.name,
                            method.name(), threshold.loops);
  return text;
}

/// Which rates cannot be had, and why.
std::string unanswered_text(const Study& study, const std::vector<MethodFindings>& methods) {
  std::string text;
  for (const MethodFindings& method : methods)
    for (const UnansweredPart& part : unanswered_parts(study, method.rates))
      text += fmt::format("{}: {}\n", method.name(), part.reason);
  return text.empty() ? text : fmt::format("\n{}", text);
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
  table.add({"pair", "truth", "loops", "right: first alone", "second alone", "p", "corrected"});
  for (const MethodPair& pair : summary.pairs)
    if (pair.loops > 0)
      table.add(
          {fmt::format("{} / {}", summary.methods[pair.first].name(), summary.methods[pair.second].name()),
           std::string(to_string(pair.truth)), fmt::format("{}", pair.loops),
           fmt::format("{}", pair.test.lost), fmt::format("{}", pair.test.gained),
           fmt::format("{:.2g}", pair.test.p_two_sided), fmt::format("{:.2g}", pair.p_holm)});
  const bool none = std::none_of(summary.pairs.begin(), summary.pairs.end(),
                                 [](const MethodPair& pair) { return pair.loops > 0; });
  if (none)
    return "";
  return fmt::format(
      "\n{}(right: a loop with a fault, or with one that has an impact, is flagged and no other;\n"
      "p: McNemar's exact test, two-sided, over the loops that both gave a verdict on; corrected: by Holm, "
      "for\nall pairs of a truth)\n",
      table.text());
}

}  // namespace

std::string comparison_text(const Campaign& campaign, const StudyFindings& findings) {
  std::string text = fmt::format("{}: {} of {} experiments compared; [{:g} % interval], loops looked at\n",
                                 campaign.study.name, findings.assessed, findings.experiments,
                                 100.0 * campaign.study.aggregate.confidence);
  for (std::size_t first = 0; first < findings.methods.size(); first += kMethodsAbreast)
    text += fmt::format("\n{}", rates_text(campaign.study, findings.methods, first,
                                           std::min(first + kMethodsAbreast, findings.methods.size())));
  return fmt::format("{}\n{}{}{}{}{}{}", text, wrapped(kOfOneBenchmark, kLineWidth), marks_text(findings),
                     calibration_text(campaign, findings), unanswered_text(campaign.study, findings.methods),
                     reasons_text(findings.methods), pairs_text(findings));
}

}  // namespace mpm
