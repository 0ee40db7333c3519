#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/methods/chain_numbers.hpp"
#include "analysis/statistics/roc.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

const Pen kCurve{colour::kBlue, Dash::solid, Mark::none, 2.0};
const Pen kBest{colour::kVermillion, Dash::none, Mark::diamond, 1.0, 1.0};
const Pen kStudy{colour::kBlack, Dash::none, Mark::circle, 1.0, 1.4};

/// I_MPM of the experiments with impact and a single fault.
struct Scores {
  std::vector<double> mpm, ud;

  explicit Scores(const Campaign& campaign) {
    records_of(campaign).each([this](const ExperimentRecord& record) {
      const AssessmentRecord* const chain = record.by(kChainMethod);
      if (chain == nullptr || !chain->flagged)
        return;
      if (record.draw.kind == ExperimentKind::mpm)
        mpm.push_back(chain->number("i_mpm"));
      if (record.draw.kind == ExperimentKind::ud)
        ud.push_back(chain->number("i_mpm"));
    });
  }
};

/// All numbers of the section.
struct Roc {
  RocCurve curve;
  Interval area, threshold;
  RocPoint at_study;

  Roc(const Study& study, const Scores& scores)
      : curve(roc_curve(scores.mpm, scores.ud)), area{}, threshold{}, at_study{} {
    if (!curve.defined())
      return;
    area = area_interval(curve.area, curve.positives, curve.negatives, study.aggregate.confidence);
    // The regressions have the first streams of this purpose, this one the last.
    RandomStream stream(study.seed, std::numeric_limits<std::uint64_t>::max(), StreamId::bootstrap);
    threshold = best_threshold_interval(scores.mpm, scores.ud, stream,
                                        {study.aggregate.bootstrap_replications, study.aggregate.confidence});
    at_study = roc_point(scores.mpm, scores.ud, study.diagnosis.mpm_threshold);
  }
};

std::string point_name(const RocPoint& point) {
  return fmt::format(
      "I_MPM > {:.4f}: {:.1f} % of MPM found, {:.1f} % of UD taken for MPM, precision {:.1f} %",
      point.threshold, 100.0 * point.true_positive_rate, 100.0 * point.false_positive_rate,
      100.0 * point.precision);
}

Panel roc_panel(const Roc& roc) {
  std::vector<double> x, y;
  roc.curve.each([&](const RocPoint& point) {
    x.push_back(100.0 * point.false_positive_rate);
    y.push_back(100.0 * point.true_positive_rate);
  });
  PanelScript panel(
      "roc",
      fmt::format("ROC: area {:.3f} ({:.3f} to {:.3f})", roc.curve.area, roc.area.lower, roc.area.upper),
      {.label = "UD taken for MPM (%)", .lower = 0, .upper = 100, .ticks = {0, 20, 40, 60, 80, 100}},
      {.label = "MPM found (%)", .lower = 0, .upper = 101, .ticks = {0, 20, 40, 60, 80, 100}});
  panel.line({0, 100}, {0, 100}, kChance);
  panel.line(x, y, kCurve);
  panel.points({{100.0 * roc.curve.best.false_positive_rate, 100.0 * roc.curve.best.true_positive_rate,
                 "largest J, " + point_name(roc.curve.best)}},
               kBest);
  panel.points({{100.0 * roc.at_study.false_positive_rate, 100.0 * roc.at_study.true_positive_rate,
                 "threshold of the study, " + point_name(roc.at_study)}},
               kStudy);
  return panel.finish("Receiver operating characteristic of I_MPM, mismatch against disturbance.", 360);
}

Panel precision_panel(const Roc& roc) {
  std::vector<double> x, y;
  roc.curve.each([&](const RocPoint& point) {
    x.push_back(100.0 * point.true_positive_rate);
    y.push_back(100.0 * point.precision);
  });
  const double prevalence = 100.0 * static_cast<double>(roc.curve.positives) /
                            static_cast<double>(roc.curve.positives + roc.curve.negatives);
  PanelScript panel(
      "precision", fmt::format("precision and recall: average {:.3f}", roc.curve.average_precision),
      {.label = "recall: MPM found (%)", .lower = 0, .upper = 100, .ticks = {0, 20, 40, 60, 80, 100}},
      {.label = "precision: true among MPM verdicts (%)",
       .lower = 0,
       .upper = 101,
       .ticks = {0, 20, 40, 60, 80, 100}});
  panel.line({0, 100}, {prevalence, prevalence}, kChance);
  panel.line(x, y, kCurve);
  panel.points({{100.0 * roc.curve.best.true_positive_rate, 100.0 * roc.curve.best.precision,
                 "largest J, " + point_name(roc.curve.best)}},
               kBest);
  panel.points({{100.0 * roc.at_study.true_positive_rate, 100.0 * roc.at_study.precision,
                 "threshold of the study, " + point_name(roc.at_study)}},
               kStudy);
  return panel.finish("Precision against recall of I_MPM, mismatch against disturbance.", 360);
}

std::string roc_table(const Study& study, const Roc& roc) {
  HtmlTable table(fmt::format("I<sub>MPM</sub> as a classifier of {} MPM and {} UD experiments.",
                              roc.curve.positives, roc.curve.negatives),
                  {{"Rule", HtmlTable::Align::left},
                   {"Threshold"},
                   {interval_title(study)},
                   {"MPM found"},
                   {"UD taken for MPM"},
                   {"Precision"},
                   {"Youden&rsquo;s J"}});
  const auto row = [&](const char* name, const RocPoint& point, const Interval& interval) {
    table.row({name, html_number(point.threshold), html_interval(interval),
               html_number(point.true_positive_rate, true), html_number(point.false_positive_rate, true),
               html_number(point.precision, true), html_number(point.youden())});
  };
  row("threshold of the study", roc.at_study, {NAN, NAN});
  row("largest J", roc.curve.best, roc.threshold);
  return table.html();
}

}  // namespace

ReportSection roc_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const Roc roc(study, Scores(input.campaign));
  ReportSection section{"roc", "How good could I_{MPM} be with another threshold?", {}};
  if (!roc.curve.defined()) {
    section.leave_out(
        fmt::format("it needs experiments with impact of both kinds; there are {} with an MPM and "
                    "{} with a UD.",
                    roc.curve.positives, roc.curve.negatives));
    return section;
  }
  section.answer = roc_answer(roc.curve, roc.area, roc.at_study);
  Figure figure;
  figure.name = "roc";
  figure.caption =
      "I_{MPM} as a classifier, MPM against UD, experiments with impact and a single fault. The "
      "threshold with the largest J was chosen on these very data, so its rates flatter it.";
  figure.legend = {{"any threshold", kCurve},
                   {fmt::format("threshold of the study, {:g}", study.diagnosis.mpm_threshold), kStudy},
                   {fmt::format("largest J, {:.3f}", roc.curve.best.threshold), kBest},
                   {"chance", kChance}};
  figure.panels = {roc_panel(roc), precision_panel(roc)};
  section.add(std::move(figure));
  section.add(roc_table(study, roc));
  return section;
}

}  // namespace mpm
