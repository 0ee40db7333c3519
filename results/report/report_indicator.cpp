#include <cmath>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_heading.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kRight{colour::kBlue, Dash::none, Mark::dot, 1.0, 0.5};
const Pen kWrong{colour::kVermillion, Dash::none, Mark::triangle, 1.0, 0.6};
const Pen kBoth{colour::kGreen, Dash::none, Mark::dot, 1.0, 0.5};
const Pen kMean{colour::kBlack, Dash::solid, Mark::square, 2.0, 0.6};

/// Returns I_MPM if the rates of I_MPM count this experiment, as in the findings; otherwise NaN.
double judged_indicator(const Study& study, const ExperimentRecord& record) {
  const AssessmentRecord* const chain = record.diagnosed();
  return chain != nullptr && in_source_population(study, *chain) ? chain->number("i_mpm") : NAN;
}

std::string population(const Study& study) {
  return study.diagnosis.source_population == SourcePopulation::impactful ? "with impact" : "feasible";
}

double highest_indicator(const Campaign& campaign) {
  double highest = mpm_threshold(campaign.study);
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (const double i_mpm = judged_indicator(campaign.study, record); std::isfinite(i_mpm))
      highest = std::fmax(highest, i_mpm);
  });
  return 1.05 * highest;
}

Axis indicator_axis(const Campaign& campaign) {
  return {.label = "I_{MPM} (-)", .lower = 0.0, .upper = highest_indicator(campaign)};
}

Panel kind_panel(const ReportInput& input, const KindFindings& kind) {
  const Campaign& campaign = input.campaign;
  const Study& study = campaign.study;
  std::vector<NamedPoint> right, wrong;
  records_of(campaign).each([&](const ExperimentRecord& record) {
    const double i_mpm = judged_indicator(study, record);
    if (record.draw.kind != kind.kind || !std::isfinite(i_mpm))
      return;
    const Judgement judgement = judge(study, record, *record.diagnosed());
    (judgement.source() == Correctness::right ? right : wrong)
        .push_back({static_cast<double>(record.draw.index), i_mpm, experiment_line(study, record),
                    experiment_anchor(input, record)});
  });
  const Rate& rate = kind.source_recognised;
  PanelScript panel(fmt::format("impm_{}", to_string(kind.kind)),
                    fmt::format("{}: {} of {} recognised", kind_name(kind.kind), rate.hits, rate.total),
                    {.label = "experiment"}, indicator_axis(campaign));
  panel.across(mpm_threshold(study), kThreshold);
  panel.points(right, kRight);
  panel.points(wrong, kWrong);
  return panel.finish(
      fmt::format("I_MPM of the {} experiments by number, with the threshold.", kind_name(kind.kind)));
}

Panel dominance_panel(const ReportInput& input, const std::vector<DominanceBin>& bins) {
  const Campaign& campaign = input.campaign;
  const Study& study = campaign.study;
  std::vector<NamedPoint> points;
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (const double i_mpm = judged_indicator(study, record);
        record.draw.kind == ExperimentKind::mpm_ud && std::isfinite(i_mpm)) {
      const double dominance = record.diagnosed()->number("dominance_mpm");
      points.push_back({dominance, i_mpm,
                        experiment_line(study, record) + fmt::format(", dominance {:.2f}", dominance),
                        experiment_anchor(input, record)});
    }
  });
  std::vector<Whisker> means;
  for (const DominanceBin& bin : bins)
    means.push_back({0.5 * (bin.lower + bin.upper), bin.i_mpm.mean, bin.i_mpm.mean_interval.lower,
                     bin.i_mpm.mean_interval.upper,
                     fmt::format("dominance {:g} to {:g}: mean {:.3f} of {} experiments", bin.lower,
                                 bin.upper, bin.i_mpm.mean, bin.i_mpm.count)});
  PanelScript panel("dominance", "", {.label = "dominance_{MPM} (-)", .lower = 0.0, .upper = 1.0},
                    indicator_axis(campaign));
  panel.across(mpm_threshold(study), kThreshold);
  panel.points(points, kBoth);
  panel.upright_whiskers(means, kMean);
  return panel.finish(
      "I_MPM of the experiments with both faults against the dominance of the mismatch, with "
      "means of four bins.");
}

}  // namespace

Section indicator_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  Section section{"indicator", "Is the source found? I_{MPM} by experiment", {}};
  Figure figure;
  figure.name = "i-mpm";
  figure.caption = fmt::format(
      "I_{{MPM}} of the located CV, experiments {}; thesis figure 6.21. Above the threshold {:g} the verdict "
      "is MPM, below it UD.",
      population(study), mpm_threshold(study));
  figure.legend = {{"source right", kRight}, {"source wrong", kWrong}, {"threshold", kThreshold}};
  for (const KindFindings& kind : input.kinds())
    if (kind.kind != ExperimentKind::mpm_ud && kind.source_recognised.total > 0)
      figure.panels.push_back(kind_panel(input, kind));
  if (figure.panels.empty())
    section.leave_out("no experiment with a single fault has an I_MPM to judge.");
  else
    section.add(std::move(figure));
  section.answer = indicator_answer(input);
  return section;
}

Section dominance_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const std::vector<DominanceBin>& bins = input.findings().dominance;
  Section section{"dominance", "Which of two faults does I_{MPM} point to?", {}};
  std::int64_t count = 0;
  for (const DominanceBin& bin : bins)
    count += bin.i_mpm.count;
  if (count == 0) {
    section.leave_out("no experiment with both faults has a dominance and an I_MPM.");
    return section;
  }
  section.answer = dominance_answer(input);
  Figure figure;
  figure.name = "dominance";
  figure.caption = fmt::format(
      "I_{{MPM}} against dominance_{{MPM}}, the share of the mismatch in Ivar_{{diag}} "
      "(6.23); experiments with both faults, {}; thesis figure 6.24.",
      population(study));
  figure.legend = {
      {"experiment", kBoth}, {"mean of a bin with its interval", kMean}, {"threshold", kThreshold}};
  figure.panels = {dominance_panel(input, bins)};
  section.add(std::move(figure));
  section.add(dominance_table(study, bins));
  return section;
}

}  // namespace mpm
