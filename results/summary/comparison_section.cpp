#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/findings/method_rates.hpp"
#include "results/plot/plot_text.hpp"
#include "results/summary/comparison.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

using Methods = std::vector<MethodFindings>;

Number area(const RocCurve& roc, const Interval& interval) {
  return roc.defined() ? Number{roc.area, NumberForm::fixed, interval, roc.positives + roc.negatives}
                       : Number{};
}

/// The share of healthy loops that the method says it flags, with a mark if the loops contradict it.
Cell stated_cell(const MethodFindings& method) {
  const MethodDescription& description = method.form->method();
  const FalseAlarmMark mark = false_alarm_mark(description, method.rates);
  Cell cell = description.stated_false_alarms ? fmt::format("{:.1f}", 100 * *description.stated_false_alarms)
                                              : std::string("none");
  if (mark != FalseAlarmMark::none) {
    cell.mark = fmt::format(" ({} found) !", to_string(mark));
    cell.tone = Cell::Tone::strong;
  }
  return cell;
}

/// A table with words in the first column and one column per method.
class MethodsTable {
 public:
  MethodsTable(std::string caption, std::string what, const Methods& methods)
      : methods_(methods), table_(std::move(caption), {{std::move(what), Table::Align::left}}) {
    for (const MethodFindings& method : methods)
      table_.columns.push_back({as_label(method.name())});
  }
  void row(const std::string& words, const std::function<Cell(const MethodFindings&)>& cell) {
    std::vector<Cell> cells{words};
    for (const MethodFindings& method : methods_)
      cells.push_back(cell(method));
    table_.row(std::move(cells));
  }
  Table take() { return std::move(table_); }

 private:
  const Methods& methods_;
  Table table_;
};

Table rates_table(const Study& study, const Methods& methods) {
  MethodsTable table(fmt::format("Shares of loops in %, with {:g} % intervals and the number of loops "
                                 "counted. Rates without a loop are left out.",
                                 100 * study.aggregate.confidence),
                     "% of loops", methods);
  for (const RateRow* const row : counted_rates(methods))
    table.row(row->heading, [&](const MethodFindings& m) {
      return number_of(m.rates.rates.of(*row), NumberForm::percent);
    });
  table.row(kStatedAlarmsHeading, stated_cell);
  for (const AreaRow& row : area_rows())
    table.row(row.heading,
              [&](const MethodFindings& m) { return area(m.rates.*row.curve, m.rates.*row.interval); });
  for (const EstimateRow& row : estimate_rows())
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const MethodFindings& m) { return m.rates.estimates.of(row).count > 0; }))
      table.row(row.heading, [&](const MethodFindings& m) { return number_of(m.rates.estimates.of(row)); });
  table.row(kRunTime.heading, [](const MethodFindings& m) -> Cell {
    return std::isnan(m.rates.milliseconds) ? "-" : fmt::format("{:.2f}", m.rates.milliseconds);
  });
  return table.take();
}

/// Explains the marks of stated_cell(), if there are any.
void add_marks(Section& section, const Methods& methods) {
  if (std::any_of(methods.begin(), methods.end(), [](const MethodFindings& method) {
        return false_alarm_mark(method.form->method(), method.rates) != FalseAlarmMark::none;
      }))
    section.say(
        fmt::format("!: the interval of the false alarms on healthy loops does not contain the rate that the "
                    "method states, or {:g} % if it states none.",
                    100 * kUsualFalseAlarms));
}

/// Says which loops calibrated the thresholds, what the thresholds are, and where there were too few loops.
void add_calibration(Section& section, const Campaign& campaign, const Methods& methods) {
  const CalibrationOptions& options = *campaign.study.calibration;
  MethodsTable table(fmt::format("Thresholds from {} healthy loops and {} with a disturbance, seed {}; {} is "
                                 "at the threshold for {:g} %.",
                                 options.healthy, options.ud, campaign.calibration.seed,
                                 heading_of("false_alarm_calibrated"), 100 * options.false_alarms),
                     "threshold", methods);
  for (const ThresholdRow& row : threshold_rows())
    table.row(row.meaning, [&](const MethodFindings& m) {
      return Number{(m.rates.thresholds.*row.threshold).value.value_or(kNaN)};
    });
  section.add(table.take());
  for (const MethodFindings& method : methods)
    for (const ThresholdRow& row : threshold_rows())
      if (const CalibratedThreshold& threshold = method.rates.thresholds.*row.threshold;
          !threshold.value && threshold.loops > 0)
        section.say(fmt::format("no {} for {}: {} calibration loops with a verdict are too few", row.name,
                                as_label(method.name()), threshold.loops));
}

/// Says which rates are not available, and which loops have no verdict, with the reasons.
void add_unanswered(Section& section, const Study& study, const Methods& methods) {
  Sentences sentences;
  for (const MethodFindings& method : methods) {
    const MethodRates& rates = method.rates;
    for (const UnansweredPart& part : unanswered_parts(study, rates))
      sentences.words.push_back(fmt::format("{}: {}", as_label(method.name()), part.reason));
    if (!rates.reason.empty())
      sentences.words.push_back(fmt::format(
          "{}: no verdict on {} of {} loops, the first because: {}", as_label(method.name()),
          rates["answered"].total - rates["answered"].hits, rates["answered"].total, as_label(rates.reason)));
  }
  if (!sentences.words.empty())
    section.add(std::move(sentences));
}

void add_pairs(Section& section, bool in_worlds, const StudyFindings& findings) {
  Table table(
      fmt::format("Two methods on the loops on which both gave a verdict. A method is right if it flags the "
                  "loops with a fault (or with a fault that has an impact) and no others. p is that of "
                  "McNemar's {}, two-sided, and corrected by Holm for all pairs of a truth.",
                  in_worlds ? "test for randomly drawn worlds" : "exact test"),
      {{"Pair", Table::Align::left},
       {"Truth", Table::Align::left},
       {"Loops"},
       {"First alone right"},
       {"Second alone"},
       {"p"},
       {"corrected"}});
  for (const MethodPair& pair : findings.pairs)
    if (pair.loops > 0)
      table.row({as_label(findings.methods[pair.first].name() + " / " + findings.methods[pair.second].name()),
                 std::string(to_string(pair.truth)), pair.loops, pair.test.lost, pair.test.gained,
                 fmt::format("{:.2g}", pair.test.p_two_sided), fmt::format("{:.2g}", pair.p_holm)});
  if (!table.rows.empty())
    section.add(std::move(table));
}

}  // namespace

std::vector<const RateRow*> counted_rates(const Methods& methods) {
  std::vector<const RateRow*> counted;
  for (const RateRow& row : rate_rows())
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const MethodFindings& m) { return m.rates.rates.of(row).total > 0; }))
      counted.push_back(&row);
  return counted;
}

Section comparison_section(const Campaign& campaign, const StudyFindings& findings) {
  Section section{"comparison-rates", "All rates"};
  section.add(rates_table(campaign.study, findings.methods));
  section.say(whose_intervals(campaign.study.world.has_value()));
  add_marks(section, findings.methods);
  if (campaign.study.calibration)
    add_calibration(section, campaign, findings.methods);
  add_unanswered(section, campaign.study, findings.methods);
  add_pairs(section, campaign.study.world.has_value(), findings);
  return section;
}

std::string comparison_heading(const Study& study, const StudyFindings& findings) {
  return fmt::format("{}: {} of {} experiments compared", as_label(study.name), findings.assessed,
                     findings.experiments);
}

Document comparison_document(const Campaign& campaign, const StudyFindings& findings) {
  Section overview = comparison_overview(campaign, findings), whole = comparison_section(campaign, findings);
  overview.data = [&](nlohmann::ordered_json& json) { put_comparison(json, campaign, findings); };
  whole.shown = Shown::full;
  return {.heading = comparison_heading(campaign.study, findings),
          .sections = {std::move(overview), std::move(whole)}};
}

}  // namespace mpm
