#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"

namespace mpm {
namespace {

const Pen kMeasured{colour::kBlue, Dash::solid, Mark::dot, 2.5, 0.8};
const Pen kReported{colour::kVermillion, Dash::none, Mark::hollow_diamond, 1.0, 1.3};

/// Returns the shares that a reader asks for first. If the chain of the thesis was run, these are only its
/// own shares: a separate section compares the other methods.
std::vector<const Finding*> headline(const ReportInput& input) {
  const bool of_chain = input.findings().chain() != nullptr;
  std::vector<const Finding*> chosen;
  for (const Finding& finding : input.findings().rows)
    if (finding.prominence == Prominence::headline && finding.is_share() &&
        (!of_chain || is_own(input.findings(), finding.method)))
      chosen.push_back(&finding);
  return chosen;
}

std::string row_name(const StudyFindings& findings, const Finding& finding) {
  return finding.kind && finding.group == FindingGroup::kind
             ? fmt::format("{}: {}", kind_heading(findings, *finding.kind, finding.method), finding.label)
             : finding.label;
}

Figure headline_figure(const ReportInput& input) {
  const std::vector<const Finding*> values = headline(input);
  const auto rows = static_cast<double>(values.size());
  std::vector<Whisker> measured;
  std::vector<NamedPoint> reported;
  Axis y{.label = "", .lower = -0.6, .upper = rows - 0.4};
  y.words.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Finding& value = *values[i];
    const std::string name = row_name(input.findings(), value);
    const double at = rows - 1.0 - static_cast<double>(i);  // the first one is on top
    const Interval& interval = value.interval;
    y.words[values.size() - 1 - i] = name;
    measured.push_back(
        {at, 100.0 * value.value, 100.0 * interval.lower, 100.0 * interval.upper,
         fmt::format("{}: {:.1f} %, interval {:.1f} to {:.1f} %, {} experiments", name, 100.0 * value.value,
                     100.0 * interval.lower, 100.0 * interval.upper, value.count)});
    if (value.has_reported())
      reported.push_back(
          {100.0 * value.reported, at, fmt::format("{}: reported {:.1f} %", name, 100.0 * value.reported)});
  }
  PanelScript panel("headline", "", {.label = "share of experiments (%)", .lower = -2, .upper = 102}, y);
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

Section rates_section(const ReportInput& input) {
  Section section{"rates", "How often is the diagnosis right?", {}};
  if (input.findings().experiments == 0) {
    section.leave_out("the archive has no experiments.");
    return section;
  }
  section.answer = rates_answer(input);
  section.add(headline_figure(input));
  section.add(findings_table(input.campaign.study, input.findings()));
  return section;
}

}  // namespace mpm
