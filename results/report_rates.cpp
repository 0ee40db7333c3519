#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "results/experiment_text.hpp"
#include "results/html_table.hpp"
#include "results/panel_script.hpp"
#include "results/plot_text.hpp"
#include "results/report_sections.hpp"

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
  return as_label(value.measured.description);
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
  return table.html();
}

/// The shares that a reader asks for first.
std::vector<const SummaryValue*> headline(const ReportInput& input) {
  std::vector<const SummaryValue*> chosen;
  for (const SummaryValue& value : input.parts.values) {
    const std::string_view name = quantity(value);
    if (value.measured.name == "infeasible" || name == "located" || name == "source_recognised")
      chosen.push_back(&value);
  }
  return chosen;
}

std::string row_name(const SummaryValue& value) {
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud})
    if (belongs_to(value, kind))
      return kind_name(kind) + (quantity(value) == "located" ? ": CV located" : ": source recognised");
  return "infeasible";
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
