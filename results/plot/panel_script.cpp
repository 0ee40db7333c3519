#include "results/plot/panel_script.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

/// Returns the space beside a panel for the tics and the label of the y axis. The unit is the width of a
/// character in gnuplot, which is wider than an average letter.
int left_margin(const Axis& y) {
  if (y.words.empty())
    return 10;
  std::size_t longest = 0;
  for (const std::string& word : y.words)
    longest = std::max(longest, plain_label(word).size());
  const double letters = 0.8 * static_cast<double>(longest) + (y.label.empty() ? 2.0 : 4.0);
  return static_cast<int>(std::min(letters, 30.0));
}

}  // namespace

std::string line_words(const Pen& pen) {
  const char* dash = pen.dash == Dash::dashed ? "(8,5)" : pen.dash == Dash::dotted ? "(2,3)" : "solid";
  return fmt::format("lc rgb '{}' lw {} dt {}", pen.colour, pen.width, dash);
}

std::string mark_form(const Pen& pen) {
  constexpr int kTypes[] = {0, 7, 6, 9, 5, 13, 12};  // in the order of Mark
  return fmt::format("pt {} ps {}", kTypes[static_cast<int>(pen.mark)], pen.size);
}

std::string mark_words(const Pen& pen) {
  return fmt::format("{} lc rgb '{}'", mark_form(pen), pen.colour);
}

PanelScript::PanelScript(std::string name, std::string title, Axis x, Axis y)
    : name_(std::move(name)), title_(std::move(title)), x_(std::move(x)), y_(std::move(y)) {}

void PanelScript::see(const Axis& axis, Extent& extent, double value) const {
  if (!shows_value(axis, value))
    return;
  extent.least = std::min(extent.least, value);
  extent.largest = std::max(extent.largest, value);
}

bool PanelScript::shows(double x, double y) const {
  return shows_value(x_, x) && shows_value(y_, y);
}

std::string PanelScript::block(const std::string& rows) {
  std::string name = fmt::format("${}_{}", name_, blocks_++);
  panel_.data += fmt::format("{} << EOD\n{}EOD\n", name, rows);
  return name;
}

void PanelScript::plot(const std::string& item) {
  items_.push_back(item);
}

/// Returns the points of a curve that a screen can show. These are all points if there are at most
/// kMostOnCurve or if x falls anywhere. Otherwise the curve is cut into kMostOnCurve / 4 stretches; each
/// keeps its first, last, lowest and highest point, and one point of each gap.
std::vector<std::size_t> PanelScript::shown_places(const std::vector<double>& x,
                                                   const std::vector<double>& y) const {
  const std::size_t size = std::min(x.size(), y.size());
  std::vector<std::size_t> places;
  const std::size_t stretch =
      size <= kMostOnCurve || !std::is_sorted(x.begin(), x.end()) ? 1 : (4 * size - 1) / kMostOnCurve + 1;
  for (std::size_t begin = 0; begin < size; begin += stretch) {
    const std::size_t end = std::min(begin + stretch, size);
    std::set<std::size_t> kept;
    std::size_t lowest = size, highest = size;
    for (std::size_t i = begin; i < end; ++i) {
      if (!shows(x[i], y[i])) {
        kept.insert(i);
        while (i + 1 < end && !shows(x[i + 1], y[i + 1]))
          ++i;
        continue;
      }
      if (lowest == size || y[i] < y[lowest])
        lowest = i;
      if (highest == size || y[i] > y[highest])
        highest = i;
    }
    kept.insert({begin, end - 1});
    if (lowest != size)
      kept.insert({lowest, highest});
    places.insert(places.end(), kept.begin(), kept.end());
  }
  return places;
}

void PanelScript::curve(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen,
                        const char* style) {
  std::string rows;
  for (const std::size_t i : shown_places(x, y)) {
    if (!shows(x[i], y[i])) {
      rows += "\n";
      continue;
    }
    see(x_, x_extent_, x[i]);
    see(y_, y_extent_, y[i]);
    rows += plot_number(x[i]) + " " + plot_number(y[i]) + "\n";
  }
  if (rows.find_first_not_of('\n') != std::string::npos)
    plot(fmt::format("{} using 1:2 with {} {} notitle", block(rows), style, line_words(pen)));
}

void PanelScript::line(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen) {
  curve(x, y, pen, "lines");
}

void PanelScript::steps(const std::vector<double>& x, const std::vector<double>& y, const Pen& pen) {
  curve(x, y, pen, "steps");
}

std::string PanelScript::name_point(const std::string& name, const std::string& anchor) {
  std::string key = fmt::format("#{}:{}", name_, panel_.names.size());
  panel_.names.emplace(key, name);
  if (!anchor.empty())
    panel_.anchors.emplace(key, anchor);
  return '"' + key + '"';
}

void PanelScript::draw_marks(const std::string& rows, const Pen& pen) {
  if (!rows.empty())
    plot(fmt::format("{} using 1:2:3 with labels hypertext point {} notitle", block(rows), mark_words(pen)));
}

void PanelScript::points(const std::vector<NamedPoint>& points, const Pen& pen) {
  const std::size_t stride = (points.size() + kMostPoints - 1) / kMostPoints;
  std::string rows;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const NamedPoint& point = points[i];
    if (!shows(point.x, point.y))
      continue;
    see(x_, x_extent_, point.x);
    see(y_, y_extent_, point.y);
    rows += fmt::format("{} {} {}\n", plot_number(point.x), plot_number(point.y),
                        name_point(point.name, point.anchor));
  }
  draw_marks(rows, pen);
}

void PanelScript::draw(const std::vector<Whisker>& whiskers, const Pen& pen, bool level) {
  std::string bars, marks;
  for (const Whisker& w : whiskers) {
    const auto place = [&](double value) { return level ? std::pair(value, w.at) : std::pair(w.at, value); };
    const auto is_shown = [&](double value) { return shows(place(value).first, place(value).second); };
    const auto text = [&](double value) {
      return fmt::format("{} {}", plot_number(place(value).first), plot_number(place(value).second));
    };
    if (!is_shown(w.value))
      continue;
    for (const double value : {w.value, w.lower, w.upper}) {
      see(x_, x_extent_, place(value).first);
      see(y_, y_extent_, place(value).second);
    }
    if (is_shown(w.lower) && is_shown(w.upper))
      bars += fmt::format("{}\n{}\n\n", text(w.lower), text(w.upper));
    marks += fmt::format("{} {}\n", text(w.value), name_point(w.name));
  }
  if (!bars.empty())
    plot(fmt::format("{} using 1:2 with lines {} notitle", block(bars), line_words(pen)));
  draw_marks(marks, pen);
}

void PanelScript::across(double y, const Pen& pen) {
  if (!shows_value(y_, y))
    return;
  see(y_, y_extent_, y);
  settings_ += fmt::format("set arrow from graph 0, first {0} to graph 1, first {0} nohead back {1}\n",
                           plot_number(y), line_words(pen));
}

void PanelScript::upright(double x, const Pen& pen) {
  if (!shows_value(x_, x))
    return;
  see(x_, x_extent_, x);
  settings_ += fmt::format("set arrow from first {0}, graph 0 to first {0}, graph 1 nohead back {1}\n",
                           plot_number(x), line_words(pen));
}

void PanelScript::upright_band(double lower, double upper) {
  if (!shows_value(x_, lower) || !shows_value(x_, upper))
    return;
  settings_ += fmt::format(
      "set object rectangle from first {}, graph 0 to first {}, graph 1 behind fc rgb '#EEF1F4' "
      "fs solid noborder\n",
      plot_number(lower), plot_number(upper));
}

void PanelScript::field(double x, double y, std::string_view colour, double depth, const std::string& label) {
  depth = std::isfinite(depth) ? std::clamp(depth, 0.0, 1.0) + 0.0 : 0.0;  // gnuplot does not accept -0
  see(x_, x_extent_, x);
  see(y_, y_extent_, y);
  settings_ += fmt::format(
      "set object rectangle center first {0}, first {1} size first 1, first 1 back fc rgb '{2}' "
      "fs solid {3:.3f} noborder\nset label {4} at first {0}, first {1} center front\n",
      plot_number(x), plot_number(y), colour, depth, gnuplot_label(label));
}

Panel PanelScript::finish(std::string description, double height, double width) {
  constexpr double kAround = 80;  // approximate pixels for labels and title
  panel_.title = title_;
  panel_.description = std::move(description);
  panel_.height = height;
  panel_.width = width;
  panel_.commands = fmt::format("set lmargin {}\n", left_margin(y_));
  if (title_.empty())
    panel_.commands += "set tmargin 0.7\n";
  else
    panel_.commands +=
        fmt::format("set label 1 {} at graph 0, graph 1 offset 0, 0.9 left front\n", gnuplot_label(title_));
  panel_.commands += axis_commands('x', x_, x_extent_.least, x_extent_.largest, width - kAround) +
                     axis_commands('y', y_, y_extent_.least, y_extent_.largest, height - kAround) + settings_;
  // If there is nothing to draw, the panel shows only its axes.
  panel_.commands +=
      items_.empty() ? "plot NaN notitle\n" : fmt::format("plot {}\n", fmt::join(items_, ", \\\n  "));
  return std::move(panel_);
}

}  // namespace mpm
