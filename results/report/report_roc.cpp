#include <cmath>

#include <fmt/format.h>

#include "analysis/findings/kind_findings.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_sections.hpp"

namespace mpm {
namespace {

const Pen kCurve{colour::kBlue, Dash::solid, Mark::none, 2.0};
const Pen kBest{colour::kVermillion, Dash::none, Mark::diamond, 1.0, 1.0};
const Pen kStudy{colour::kBlack, Dash::none, Mark::circle, 1.0, 1.4};

std::string point_name(const RocPoint& point) {
  return fmt::format("I_MPM > {:.4f}: {:.1f} % of MPM found, {:.1f} % of UD taken for MPM{}", point.threshold,
                     100.0 * point.true_positive_rate, 100.0 * point.false_positive_rate,
                     std::isnan(point.precision)  // no loop is above the threshold
                         ? ""
                         : fmt::format(", precision {:.1f} %", 100.0 * point.precision));
}

/// Draws one rate against another, in percent, over all thresholds. `chance` is what guessing gives at both
/// ends of x.
Panel curve_panel(const SourceCurve& roc, const char* name, const std::string& title, const char* x_label,
                  double RocPoint::*x, const char* y_label, double RocPoint::*y,
                  const std::vector<double>& chance, const char* description) {
  const std::vector<double> ticks{0, 20, 40, 60, 80, 100};
  PanelScript panel(name, title, {.label = x_label, .lower = 0, .upper = 100, .ticks = ticks},
                    {.label = y_label, .lower = 0, .upper = 101, .ticks = ticks});
  std::vector<double> across, up;
  roc.curve.each([&](const RocPoint& point) {
    across.push_back(100.0 * point.*x);
    up.push_back(100.0 * point.*y);
  });
  panel.line({0, 100}, chance, kChance);
  panel.line(across, up, kCurve);
  const auto mark = [&](const RocPoint& point, const char* words, const Pen& pen) {
    panel.points({{100.0 * point.*x, 100.0 * point.*y, words + point_name(point)}}, pen);
  };
  mark(roc.curve.best, "largest J, ", kBest);
  mark(roc.at_study, "threshold of the study, ", kStudy);
  return panel.finish(description, 360);
}

std::vector<Panel> panels(const SourceCurve& roc) {
  const double prevalence = 100.0 * static_cast<double>(roc.curve.positives) /
                            static_cast<double>(roc.curve.positives + roc.curve.negatives);
  return {
      curve_panel(roc, "roc", fmt::format("ROC: area {:.3f}{}", roc.curve.area, interval_words(roc.area, 3)),
                  "UD taken for MPM (%)", &RocPoint::false_positive_rate, "MPM found (%)",
                  &RocPoint::true_positive_rate, {0, 100},
                  "Receiver operating characteristic of I_MPM, mismatch against disturbance."),
      curve_panel(roc, "precision",
                  fmt::format("precision and recall: average {:.3f}", roc.curve.average_precision),
                  "recall: MPM found (%)", &RocPoint::true_positive_rate,
                  "precision: true among MPM verdicts (%)", &RocPoint::precision, {prevalence, prevalence},
                  "Precision against recall of I_MPM, mismatch against disturbance.")};
}

Table roc_table(const SourceCurve& roc) {
  Table table(fmt::format("I_{{MPM}} as a classifier of {} MPM and {} UD experiments.", roc.curve.positives,
                          roc.curve.negatives),
              {{"Rule", Table::Align::left},
               {"Threshold"},
               {"MPM found"},
               {"UD taken for MPM"},
               {"Precision"},
               {"Youden's J"}});
  const auto row = [&](const char* name, const RocPoint& point, const Interval& interval) {
    table.row({name, Number{point.threshold, NumberForm::fixed, interval},
               Number{point.true_positive_rate, NumberForm::share},
               Number{point.false_positive_rate, NumberForm::share},
               Number{point.precision, NumberForm::share}, Number{point.youden(), NumberForm::fixed}});
  };
  row("threshold of the study", roc.at_study, {kNaN, kNaN});
  row("largest J", roc.curve.best, roc.best_threshold);
  return table;
}

}  // namespace

Section roc_section(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const SourceCurve roc = input.findings().source_curve.value_or(SourceCurve{});
  Section section{"roc", "How good could I_{MPM} be with another threshold?", {}};
  if (!roc.curve.defined()) {
    section.leave_out(fmt::format(
        "this needs experiments of both kinds with impact; there are {} with an MPM and {} with a UD.",
        roc.curve.positives, roc.curve.negatives));
    return section;
  }
  section.answer = roc_answer(roc.curve, roc.area, roc.at_study);
  Figure figure;
  figure.name = "roc";
  figure.caption =
      "I_{MPM} as a classifier, MPM against UD, over the loops with a single fault whose source is judged. "
      "The threshold with the largest J was chosen on these data, so its rates are optimistic.";
  figure.legend = {{"any threshold", kCurve},
                   {fmt::format("threshold of the study, {:g}", mpm_threshold(study)), kStudy},
                   {fmt::format("largest J, {:.3f}", roc.curve.best.threshold), kBest},
                   {"chance", kChance}};
  figure.panels = panels(roc);
  section.add(std::move(figure));
  section.add(roc_table(roc));
  return section;
}

}  // namespace mpm
