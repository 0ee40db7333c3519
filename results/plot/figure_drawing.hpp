#pragma once

#include <string>
#include <vector>

#include "results/plot/figure.hpp"
#include "results/plot/figure_format.hpp"

namespace mpm {

/// Draws the panels of a figure, in their order, as SVG elements for a page. An element fills the width it is
/// given, names its points with <title> elements, and needs no script. Its ids begin with the name of the
/// figure and the number of the panel, so that many fit into one page. One run of gnuplot draws all panels.
/// Errors: GnuplotError.
std::vector<std::string> draw_panels(const Figure& figure);

/// Draws all panels of a figure in a grid, with the legend above it, as the content of a file. The bytes of
/// an SVG depend only on the figure and the version of gnuplot; a PDF also holds the time. Errors:
/// GnuplotError.
std::string draw_figure(const Figure& figure, FigureFormat format);

}  // namespace mpm
