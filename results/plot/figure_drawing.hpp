#pragma once

#include <string>

#include "results/plot/figure.hpp"
#include "results/plot/figure_format.hpp"

namespace mpm {

/// One panel as an SVG element for a page: it takes the width it is given, names its points with <title>
/// elements, needs no script, and its ids begin with `id`, so that many fit into one page.
/// Errors: GnuplotError.
std::string draw_panel(const Panel& panel, const std::string& id);

/// All panels of a figure in a grid, with the legend above it, as the content of a file. The bytes of an SVG
/// depend on the figure and the version of gnuplot only; a PDF has the time in it.
/// Errors: GnuplotError.
std::string draw_figure(const Figure& figure, FigureFormat format);

}  // namespace mpm
