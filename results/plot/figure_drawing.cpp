#include "results/plot/figure_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/plot/gnuplot.hpp"
#include "results/plot/panel_script.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/svg_text.hpp"

namespace mpm {
namespace {

constexpr double kLegendRow = 18;      // pixels
constexpr double kHeadingRow = 18;     // pixels
constexpr double kColumnInches = 3.5;  // two-column paper: a panel fills one column, two the page

/// The common style of all plots: two thin axes, a pale grid, no box.
constexpr const char* kHouseStyle = R"(reset
set encoding utf8
set minussign
set border 3 lw 1 lc rgb '#59636E'
set tics nomirror out scale 0.5 textcolor rgb '#3A424A'
set format '%h'
set grid lt 1 lw 1 lc rgb '#E6E9EC'
set xtics offset 0, 0.3
set xlabel textcolor rgb '#3A424A' offset 0, 0.9
set ylabel textcolor rgb '#3A424A' offset 0.5, 0
set rmargin 2
set tmargin 2
set bmargin 2.8
unset key
)";

std::string terminal(FigureFormat format, double width, double height) {
  switch (format) {
    case FigureFormat::svg:
      return fmt::format("set terminal svg size {},{} fixed enhanced font 'Arial,12' background '#FFFFFF'\n",
                         width, height);
    case FigureFormat::pdf:  // the font has 12 pixels in a panel of kPanelWidth; judged by eye against the
                             // other two formats
      return fmt::format(
          "set terminal pdfcairo size {}in,{}in enhanced font 'Arial,7.2' fontscale 0.75 linewidth 0.6 "
          "pointscale 0.8\n",
          width * kColumnInches / kPanelWidth, height * kColumnInches / kPanelWidth);
    case FigureFormat::png:
      return fmt::format(
          "set terminal pngcairo size {},{} enhanced font 'Arial,9' fontscale 2 linewidth 2 pointscale 2\n",
          2 * width, 2 * height);
  }
  return {};
}

std::string legend_item(const LegendEntry& entry) {
  const bool line = entry.pen.dash != Dash::none;
  const bool mark = entry.pen.mark != Mark::none;
  const Pen small{entry.pen.colour, entry.pen.dash, entry.pen.mark, entry.pen.width, 0.8};
  const std::string words = line && mark ? "linespoints " + line_words(small) + " " + mark_form(small)
                            : line       ? "lines " + line_words(small)
                                         : "points " + mark_words(small);
  return "keyentry with " + words + " title " + gnuplot_label(entry.label);
}

/// Estimates how many rows gnuplot needs for the legend.
double legend_rows(const std::vector<LegendEntry>& legend, double width) {
  constexpr double kSample = 50, kCharacter = 7;  // pixels
  std::size_t longest = 0;
  for (const LegendEntry& entry : legend)
    longest = std::max(longest, plain_label(entry.label).size());
  const double columns =
      std::max(1.0, std::floor(width / (kSample + kCharacter * static_cast<double>(longest))));
  return std::ceil(static_cast<double>(legend.size()) / columns);
}

/// Writes the heading as a separate plot that holds only labels.
std::string heading_script(const std::vector<std::string>& heading, double height) {
  std::string script =
      "unset border\nunset tics\nset margins 0, 0, 0, 0\nset xrange [0:1]\nset yrange [0:1]\n";
  for (std::size_t i = 0; i < heading.size(); ++i)
    script +=
        fmt::format("set label {} {} at screen 0.5, screen {:.6f} center\n", i + 1, gnuplot_label(heading[i]),
                    1.0 - (static_cast<double>(i) + 0.6) * kHeadingRow / height);
  return script + "plot NaN notitle\n";
}

/// Writes the legend as a separate plot that holds only a key. Its rows are kLegendRow high: the SVG terminal
/// makes them 1.25 times as high as the other terminals do.
std::string legend_script(const std::vector<LegendEntry>& legend, FigureFormat format) {
  std::vector<std::string> items;
  for (const LegendEntry& entry : legend)
    items.push_back(legend_item(entry));
  return fmt::format(
      "set margins 0, 0, 0, 0\nunset border\nunset tics\nunset grid\n"
      "set key center center horizontal Left reverse samplen 2.2 maxcols {} spacing {}\n"
      "set xrange [0:1]\nset yrange [0:1]\nplot NaN notitle, {}\n",
      legend.size(), format == FigureFormat::svg ? 1.0 : 1.25, fmt::join(items, ", "));
}

/// The positions of all parts of a figure in its grid, in pixels from the top.
struct Layout {
  std::size_t columns;
  std::vector<double> row_heights;
  double heading, legend, width, height;

  explicit Layout(const Figure& figure)
      : columns(std::max<std::size_t>(1, std::min(figure.columns, figure.panels.size()))) {
    for (std::size_t first = 0; first < figure.panels.size(); first += columns) {
      double tallest = 0;
      for (std::size_t i = first; i < std::min(first + columns, figure.panels.size()); ++i)
        tallest = std::max(tallest, figure.panels[i].height);
      row_heights.push_back(tallest);
    }
    width = kPanelWidth * static_cast<double>(columns);
    heading = kHeadingRow * static_cast<double>(figure.heading.size());
    legend = figure.legend.empty() ? 0 : kLegendRow * legend_rows(figure.legend, width) + kLegendRow / 2;
    height = std::accumulate(row_heights.begin(), row_heights.end(), heading + legend);
  }

  std::string place(double left, double top, double w, double h) const {
    return fmt::format("set origin {:.6f}, {:.6f}\nset size {:.6f}, {:.6f}\n", left / width,
                       (height - top - h) / height, w / width, h / height);
  }
};

std::string figure_script(const Figure& figure, FigureFormat format) {
  const Layout layout(figure);
  std::string script = "set encoding utf8\n" + terminal(format, layout.width, layout.height);
  for (const Panel& panel : figure.panels)
    script += panel.data;
  script += "set multiplot\n";
  double top = 0;
  if (!figure.heading.empty())
    script += kHouseStyle + layout.place(0, top, layout.width, layout.heading) +
              heading_script(figure.heading, layout.height);
  top += layout.heading;
  if (!figure.legend.empty())
    script += kHouseStyle + layout.place(0, top, layout.width, layout.legend) +
              legend_script(figure.legend, format);
  top += layout.legend;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const double height = layout.row_heights[i / layout.columns];
    const double left = kPanelWidth * static_cast<double>(i % layout.columns);
    script += kHouseStyle + layout.place(left, top, kPanelWidth, height) + figure.panels[i].commands;
    if (i % layout.columns + 1 == layout.columns)
      top += height;
  }
  return script + "unset multiplot\n";
}

std::string described(const Figure& figure) {
  std::string text = plain_label(figure.caption);
  for (const std::string& line : figure.heading)
    text.append(text.empty() ? "" : " ").append(plain_label(line)).append(".");
  for (const Panel& panel : figure.panels)
    text.append(" ").append(panel.description);
  return text;
}

}  // namespace

std::vector<std::string> draw_panels(const Figure& figure) {
  constexpr std::string_view kPrologue = "<?xml";  // begins each drawing; the drawings' text has no '<'
  std::string script;
  for (const Panel& panel : figure.panels)
    script +=
        terminal(FigureFormat::svg, panel.width, panel.height) + kHouseStyle + panel.data + panel.commands;
  const std::string drawings = figure.panels.empty() ? "" : run_gnuplot(script);
  std::vector<std::string> panels;
  std::size_t begin = 0;
  for (const Panel& panel : figure.panels) {
    const std::size_t end = std::min(drawings.find(kPrologue, begin + kPrologue.size()), drawings.size());
    panels.push_back(svg_element(
        drawings.substr(begin, end - begin),
        {fmt::format("{}-{}", figure.name, panels.size()), panel.description, panel.names, panel.anchors}));
    begin = end;
  }
  return panels;
}

std::string draw_figure(const Figure& figure, FigureFormat format) {
  std::string drawing = run_gnuplot(figure_script(figure, format));
  if (format != FigureFormat::svg)
    return drawing;
  std::map<std::string, std::string> names;
  for (const Panel& panel : figure.panels)
    names.insert(panel.names.begin(), panel.names.end());
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" +
         svg_element(drawing, {figure.name, described(figure), names}) + "\n";
}

}  // namespace mpm
