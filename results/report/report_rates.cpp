#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kMeasured{colour::kBlue, Dash::solid, Mark::dot, 2.5, 0.8};
const Pen kReported{colour::kVermillion, Dash::none, Mark::hollow_diamond, 1.0, 1.3};

/// The part of a name behind the kind: "located" of "mpm.located".
std::string_view quantity(const SummaryValue& value) {
  const std::string_view name = value.measured.name;
  return name.substr(name.find('.') + 1);
}

bool belongs_to(const SummaryValue& value, ExperimentKind kind) {
  return value.measured.name.rfind(std::string(to_string(kind)) + ".", 0) == 0;
}

/// A number of the experiments in which model and plant agree.
bool is_faultless_share(const SummaryValue& value) {
  const std::string& name = value.measured.name;
  return name.starts_with("infeasible_") || name.starts_with("false_");
}

/// The same as a label: "false alarm, tuning move suppression".
std::string faultless_label(std::string name) {
  for (const char* quantity : {"infeasible", "false_alarm", "false_mpm", "false_ud"})
    if (const std::size_t length = std::strlen(quantity); name.starts_with(std::string(quantity) + "_")) {
      name.replace(length, 1, ",_");
      break;
    }
  std::replace(name.begin(), name.end(), '_', ' ');
  return as_label(name);
}

/// What a reader calls the quantity, as a label.
std::string quantity_label(const SummaryValue& value, const Study& study) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 8> kLabels{
      {{"infeasible", "infeasible"},
       {"impactful", "with impact"},
       {"r_squared", "R\xC2\xB2 of Ivar_{basis} on Ivar"},
       {"slope", "slope of Ivar_{basis} on Ivar"},
       {"located", "affected CV located"},
       {"i_mpm_min", "smallest I_{MPM}"},
       {"i_mpm_mean", "mean I_{MPM}"},
       {"i_mpm_max", "largest I_{MPM}"}}};
  for (const auto& [name, label] : kLabels)
    if (quantity(value) == name)
      return label;
  if (quantity(value) == "source_recognised")
    return fmt::format("source recognised, I_{{MPM}} {} {:g}",
                       belongs_to(value, ExperimentKind::mpm) ? ">" : "<", study.diagnosis.mpm_threshold);
  return is_faultless_share(value) ? faultless_label(value.measured.name)
                                   : as_label(value.measured.description);
}

std::string agreement(const SummaryValue& value) {
  const Interval& interval = value.measured.interval;
  if (!value.has_reported() || std::isnan(interval.lower))
    return "";
  return interval.contains(value.reported) ? "<span class=\"yes\">yes</span>"
                                           : "<span class=\"no\">no</span>";
}

void add_row(HtmlTable& table, const SummaryValue& value, const Study& study) {
  const bool share = value.is_share();
  table.row({html_label(quantity_label(value, study)), html_number(value.measured.value, share),
             html_interval(value.measured.interval, share), html_number(value.reported, share),
             agreement(value), fmt::format("{}", value.measured.count)});
}

std::string rates_table(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const bool any = std::any_of(input.parts.values.begin(), input.parts.values.end(),
                               [](const SummaryValue& value) { return value.has_reported(); });
  HtmlTable table(any ? "Measured values beside those that the study names as reported, and whether the "
                        "reported value lies in the interval."
                      : "Measured values; the study names no reported ones.",
                  {{"Quantity", HtmlTable::Align::left},
                   {"Measured"},
                   {interval_title(study)},
                   {"Reported"},
                   {"In interval", HtmlTable::Align::left},
                   {"Count"}});
  table.group("All experiments");
  for (const SummaryValue& value : input.parts.values)
    if (value.measured.name == "infeasible")
      add_row(table, value, study);
  for (const KindAggregate& kind : input.parts.aggregate.kinds) {
    table.group(kind_name(kind.kind));
    for (const SummaryValue& value : input.parts.values)
      if (belongs_to(value, kind.kind) && value.measured.name.find("_at_dominance_") == std::string::npos)
        add_row(table, value, study);
  }
  if (!input.parts.aggregate.false_alarms.empty())
    table.group("Model and plant agree");
  for (const SummaryValue& value : input.parts.values)
    if (is_faultless_share(value))
      add_row(table, value, study);
  return table.html();
}

/// The shares that a reader asks for first.
std::vector<const SummaryValue*> headline(const ReportInput& input) {
  std::vector<const SummaryValue*> chosen;
  for (const SummaryValue& value : input.parts.values) {
    const std::string_view name = quantity(value);
    if (value.measured.name == "infeasible" || name == "located" || name == "source_recognised" ||
        name == "false_alarm_healthy" || name == "false_alarm_tuning")
      chosen.push_back(&value);
  }
  return chosen;
}

std::string row_name(const SummaryValue& value) {
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud})
    if (belongs_to(value, kind))
      return kind_name(kind) + (quantity(value) == "located" ? ": CV located" : ": source recognised");
  if (quantity(value) == "false_alarm_healthy")
    return "healthy: false alarm";
  return quantity(value) == "false_alarm_tuning" ? "tuning: false alarm" : "infeasible";
}

Figure headline_figure(const ReportInput& input) {
  const std::vector<const SummaryValue*> values = headline(input);
  const auto rows = static_cast<double>(values.size());
  std::vector<Whisker> measured;
  std::vector<NamedPoint> reported;
  Axis y{.label = "", .lower = -0.6, .upper = rows - 0.4};
  y.words.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const SummaryValue& value = *values[i];
    const std::string name = row_name(value);
    const double at = rows - 1.0 - static_cast<double>(i);  // the first one on top
    const Interval& interval = value.measured.interval;
    y.words[values.size() - 1 - i] = name;
    measured.push_back({at, 100.0 * value.measured.value, 100.0 * interval.lower, 100.0 * interval.upper,
                        fmt::format("{}: {:.1f} %, interval {:.1f} to {:.1f} %, {} experiments", name,
                                    100.0 * value.measured.value, 100.0 * interval.lower,
                                    100.0 * interval.upper, value.measured.count)});
    if (value.has_reported())
      reported.push_back(
          {100.0 * value.reported, at, fmt::format("{}: reported {:.1f} %", name, 100.0 * value.reported)});
  }
  PanelScript panel("headline", "", {.label = "share of experiments (%)", .lower = -2, .upper = 102}, y);
  panel.left_margin(23);
  panel.points(reported, kReported);
  panel.level_whiskers(measured, kMeasured);
  Figure figure;
  figure.name = "headline-rates";
  figure.caption =
      "Headline rates with their intervals. \"Located\" and \"recognised\" are shares of the "
      "experiments with impact.";
  figure.legend = {
      {fmt::format("measured, {:g} % interval", 100.0 * input.campaign.study.aggregate.confidence),
       kMeasured}};
  if (!reported.empty())
    figure.legend.push_back({"reported", kReported});
  figure.panels = {
      panel.finish("Headline rates as points with intervals beside the reported values; the "
                   "table below has the numbers.",
                   70.0 + 30.0 * rows)};
  figure.columns = 1;
  return figure;
}

}  // namespace

ReportSection rates_section(const ReportInput& input) {
  ReportSection section{"rates", "Headline rates", {}};
  if (input.parts.aggregate.experiments == 0) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  section.add(headline_figure(input));
  section.add(rates_table(input));
  return section;
}

}  // namespace mpm
