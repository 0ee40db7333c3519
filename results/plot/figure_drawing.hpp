#pragma once

#include <string>
#include <vector>

#include "results/plot/figure.hpp"
#include "results/plot/figure_format.hpp"

namespace mpm {

/// The panels of a figure, in their order, as SVG elements for a page: each takes the width it is given,
/// names its points with <title> elements, needs no script, and its ids begin with the name of the figure and
/// the number of the panel, so that many fit into one page. One run of gnuplot draws them all. Errors:
/// GnuplotError.
std::vector<std::string> draw_panels(const Figure& figure);

/// All panels of a figure in a grid, with the legend above it, as the content of a file. The bytes of an SVG
/// depend on the figure and the version of gnuplot only; a PDF has the time in it.
/// Errors: GnuplotError.
std::string draw_figure(const Figure& figure, FigureFormat format);

}  // namespace mpm
