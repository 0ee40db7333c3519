#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_heading.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kQuiet{colour::kBlue, Dash::none, Mark::dot, 1.0, 0.5};
const Pen kAlarm{colour::kVermillion, Dash::none, Mark::triangle, 1.0, 0.6};
const Pen kCost{colour::kGrey, Dash::none, Mark::circle, 1.0, 0.5};

/// Returns easily read numbers for a logarithmic axis between these values.
std::vector<double> round_numbers(double least, double largest) {
  std::vector<double> ticks;
  for (const double number :
       {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8, 1.0, 1.2, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (number >= least && number <= largest)
      ticks.push_back(number);
  return ticks;
}

/// Draws for each experiment the indices farthest from 1, against the factor of the weight, or against the
/// number of the experiment.
Panel group_panel(const ReportInput& input, const FalseAlarms& group) {
  const Study& study = input.campaign.study;
  double least = study.diagnosis.impact_lower, largest = study.diagnosis.impact_upper;
  std::vector<NamedPoint> quiet, alarms, costs;
  records_of(input.campaign).each([&](const ExperimentRecord& record) {
    const AssessmentRecord& chain = record.chain();
    if (!chain.answered() || !group.has(record.draw))
      return;
    const double x = group.parameter ? record.draw.tuning->factor : static_cast<double>(record.draw.index);
    const auto farthest = [&](const char* index, const Eigen::VectorXd& values) -> NamedPoint {
      const Eigen::Index cv = farthest_from_one(values, study.diagnosis.location_distance);
      const double value = cv < 0 ? NAN : values(cv);
      if (value > 0.0 && std::isfinite(value)) {
        least = std::min(least, value);
        largest = std::max(largest, value);
      }
      return {x, value,
              fmt::format("{}; {} of {} {:.3g}", experiment_line(study, record), index, cv_name(study, cv),
                          value),
              experiment_anchor(input, record)};
    };
    costs.push_back(farthest("Ivar_basis", record.ivar_basis));
    (chain.flagged ? alarms : quiet).push_back(farthest("Ivar", chain.values("ivar").reshaped()));
  });
  const Rate& rate = group.false_alarm;
  PanelScript panel("alarm_" + group.name(),
                    fmt::format("{}: {} of {} false alarms", group.label(), rate.hits, rate.total),
                    group.parameter ? Axis{.label = "factor of the weight (-)", .logarithmic = true}
                                    : Axis{.label = "experiment"},
                    {.label = "index farthest from 1 (-)",
                     .logarithmic = true,
                     .ticks = round_numbers(least / 1.05, largest * 1.05)});
  panel.across(study.diagnosis.impact_lower, kThreshold);
  panel.across(study.diagnosis.impact_upper, kThreshold);
  panel.points(costs, kCost);
  panel.points(quiet, kQuiet);
  panel.points(alarms, kAlarm);
  return panel.finish(fmt::format(
      "Ivar farthest from 1 of the experiments of the group {}, with the band of impact.", group.label()));
}

Table false_alarm_rates_table(const ReportInput& input) {
  Table table(
      "Experiments in which model and plant agree: the share of the feasible ones that the chain calls a "
      "modelling error with impact, and the source it names.",
      {{"Experiments", Table::Align::left},
       {"Infeasible"},
       {"False alarms"},
       {"as MPM"},
       {"as UD"},
       {"Feasible"}});
  for (const FalseAlarms& group : input.false_alarms())
    table.row({(group.parameter ? "- " : "") + group.label(), share(group.infeasible.value),
               number(group.false_alarm), share(group.false_mpm.value), share(group.false_ud.value),
               group.false_alarm.total});
  return table;
}

}  // namespace

Section false_alarm_section(const ReportInput& input) {
  Section section{"false-alarms", "Are there alarms although the model is right?", {}};
  const std::vector<FalseAlarms>& groups = input.false_alarms();
  section.answer = false_alarm_answer(input);
  Figure figure;
  figure.name = "false-alarms";
  figure.caption =
      "The Ivar farthest from 1 of each experiment: healthy ones by their number, bad tunings against the "
      "factor of the weight. Outside the band the chain sees a modelling error that does not exist. "
      "Ivar_{basis} shows the true effect of the noise or the tuning on the variance of a CV.";
  figure.legend = {{"Ivar: no alarm", kQuiet},
                   {"Ivar: false alarm", kAlarm},
                   {"Ivar_{basis}", kCost},
                   {"band of impact", kThreshold}};
  for (const FalseAlarms& group : groups)
    if ((group.parameter || group.kind == ExperimentKind::healthy) && group.false_alarm.total > 0)
      figure.panels.push_back(group_panel(input, group));
  if (!figure.panels.empty())
    section.add(std::move(figure));
  if (const Study& study = input.campaign.study; study.experiments.tuning > 0)
    section.say(study.tuning.sensitivity == TuningSensitivity::current
                    ? "S0 of an experiment with a bad tuning is that of the controller with this tuning."
                    : "S0 of an experiment with a bad tuning is that of the controller of the study, as if "
                      "nobody had noticed the change.");
  section.add(false_alarm_rates_table(input));
  return section;
}

}  // namespace mpm
