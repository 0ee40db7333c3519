#pragma once

#include <Eigen/Core>

#include "results/plot/figure.hpp"

namespace mpm {

/// How the curve of a CV is drawn in every panel: CVs differ in colour, and in dash once the colours are used
/// up. The one that a panel is about is thick.
Pen cv_pen(Eigen::Index cv, bool thick = false);

}  // namespace mpm
