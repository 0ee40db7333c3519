#pragma once

#include <string>

#include "results/plot/figure.hpp"

namespace mpm {

/// Writes a figure for a page: legend, panels, caption. Errors: GnuplotError.
std::string figure_html(const Figure& figure);

}  // namespace mpm
