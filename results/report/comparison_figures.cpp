#include "results/report/comparison_figures.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "results/plot/panel_script.hpp"
#include "results/plot/pens.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

using Methods = std::vector<MethodFindings>;

/// With more methods than this, the rows are closer together.
constexpr std::size_t kFewMethods = 8;

/// The pen of a method, for a curve.
Pen curve_pen(std::size_t method) {
  Pen pen = method_pen(method);
  pen.mark = Mark::none;
  return pen;
}

/// The pen of a method, for whiskers: solid, so that short ones are visible.
Pen whisker_pen(std::size_t method) {
  Pen pen = method_pen(method);
  pen.dash = Dash::solid;
  return pen;
}

/// Returns the positions of the methods that gave some verdict. The others would be empty rows.
std::vector<std::size_t> answering(const Methods& methods) {
  std::vector<std::size_t> places;
  for (std::size_t m = 0; m < methods.size(); ++m)
    if (methods[m].rates["answered"].hits > 0)
      places.push_back(m);
  return places;
}

Whisker rate_whisker(const MethodFindings& method, const Rate& rate, double at) {
  const double value = 100.0 * rate.value;
  const double lower = 100.0 * rate.interval.lower, upper = 100.0 * rate.interval.upper;
  return {at, value, lower, upper,
          fmt::format("{}: {:.1f} %, interval {:.1f} to {:.1f} %, {} of {} loops", method.name(), value,
                      lower, upper, rate.hits, rate.total)};
}

Panel rate_panel(const RateRow& row, const Methods& methods) {
  const std::vector<std::size_t> places = answering(methods);
  const auto rows = static_cast<double>(places.size());
  Axis y{.label = "", .lower = -0.6, .upper = rows - 0.4};
  for (const std::size_t place : places)
    y.words.push_back(methods[place].name());
  std::reverse(y.words.begin(), y.words.end());  // the first one on top
  PanelScript panel(row.name, row.heading,
                    {.label = row.low_is_good ? "% of loops, left is good" : "% of loops, right is good",
                     .lower = -2,
                     .upper = 102,
                     .ticks = {0, 20, 40, 60, 80, 100}},
                    y);
  double at = rows;
  for (const std::size_t place : places) {
    const Rate& rate = methods[place].rates.rates.of(row);
    at -= 1.0;
    if (rate.total > 0)
      panel.level_whiskers({rate_whisker(methods[place], rate, at)}, whisker_pen(place));
  }
  return panel.finish(fmt::format("Share of loops with its interval, one row a method: {}.", row.meaning),
                      70.0 + (places.size() > kFewMethods ? 18.0 : 28.0) * rows);
}

/// Draws the curve with at most kMostPoints points, always including the first and the last.
void draw_curve(PanelScript& panel, const RocCurve& roc, const Pen& pen) {
  std::vector<double> x, y;
  const std::size_t stride = roc.size / kMostPoints + 1;
  std::size_t i = 0;
  roc.each([&](const RocPoint& point) {
    if (i++ % stride != 0 && i != roc.size)
      return;
    x.push_back(100.0 * point.false_positive_rate);
    y.push_back(100.0 * point.true_positive_rate);
  });
  panel.line(x, y, pen);
}

const RocCurve& curve_of(const MethodFindings& method, FlagTruth truth) {
  return truth == FlagTruth::fault ? method.rates.roc : method.rates.roc_impact;
}

/// The names and texts of a figure of curves.
struct RocWords {
  const char *figure, *panel, *x, *y, *caption, *description;
};

RocWords roc_words(FlagTruth truth) {
  if (truth == FlagTruth::fault)
    return {
        "comparison-roc",
        "comparison_roc",
        "healthy loops flagged (%)",
        "loops with a fault flagged (%)",
        "Each method with every threshold on its score; after its area stand the numbers of loops with a "
        "fault and of healthy loops. The mark is its own verdict, which lies off the curve if the method "
        "flags by more than one number.",
        "Receiver operating characteristics of the scores of the methods, loops with a fault against healthy "
        "ones."};
  return {"comparison-roc-impact",
          "comparison_roc_impact",
          "loops without an impact flagged (%)",
          "loops with an impact flagged (%)",
          "The same with impact as the truth: only loops whose fault has an impact should be flagged. After "
          "the area: the numbers of loops with an impact and without.",
          "Receiver operating characteristics of the scores of the methods, loops whose fault has an impact "
          "against healthy ones and those whose fault has none."};
}

/// The point at which the method itself draws the line: its shares of flagged healthy and faulty loops.
NamedPoint verdict_point(const MethodFindings& method) {
  const double x = 100.0 * method.rates["false_alarm_healthy"].value,
               y = 100.0 * method.rates["detected"].value;
  return {x, y,
          fmt::format("{}: {:.1f} % of the faults detected, {:.1f} % false alarms", method.name(), y, x)};
}

}  // namespace

Figure comparison_rates_figure(const Study& study, const Methods& methods) {
  Figure figure;
  figure.name = "comparison-rates";
  figure.caption = fmt::format("How often each method that gave a verdict is right, with {:g} % intervals.",
                               100.0 * study.aggregate.confidence);
  for (const RateRow* const row : counted_rates(methods))
    if (row->name != std::string_view("answered"))
      figure.panels.push_back(rate_panel(*row, methods));
  return figure;
}

bool has_curves(const Methods& methods, FlagTruth truth) {
  return std::any_of(methods.begin(), methods.end(),
                     [&](const MethodFindings& m) { return curve_of(m, truth).defined(); });
}

Figure comparison_roc_figure(const Methods& methods, FlagTruth truth) {
  const RocWords words = roc_words(truth);
  const std::vector<double> ticks{0, 20, 40, 60, 80, 100};
  PanelScript panel(words.panel, "", {.label = words.x, .lower = 0, .upper = 100, .ticks = ticks},
                    {.label = words.y, .lower = 0, .upper = 101, .ticks = ticks});
  panel.line({0, 100}, {0, 100}, kChance);
  Figure figure;
  figure.name = words.figure;
  figure.caption = words.caption;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const RocCurve& curve = curve_of(methods[m], truth);
    if (!curve.defined())
      continue;
    draw_curve(panel, curve, curve_pen(m));
    const Interval& area =
        truth == FlagTruth::fault ? methods[m].rates.roc_area : methods[m].rates.roc_impact_area;
    figure.legend.push_back({fmt::format("{}, area {:.3f}{}, {} and {} loops", methods[m].name(), curve.area,
                                         interval_words(area, 3), curve.positives, curve.negatives),
                             method_pen(m)});
  }
  for (std::size_t m = 0; m < methods.size() && truth == FlagTruth::fault; ++m)
    if (methods[m].rates.roc.defined())
      panel.points({verdict_point(methods[m])}, method_pen(m));
  figure.legend.push_back({"chance", kChance});
  figure.panels = {panel.finish(words.description, 360)};
  return figure;
}

}  // namespace mpm
