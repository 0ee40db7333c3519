#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "results/plot/figure.hpp"

namespace mpm {

/// How the curve of a CV is drawn in every panel: CVs differ in colour, and in dash once the colours are used
/// up. The one that a panel is about is thick.
Pen cv_pen(Eigen::Index cv, bool thick = false);

/// How a method is drawn among others: 21 differ in colour, and neighbours in dash and mark as well.
Pen method_pen(std::size_t method);

/// A threshold of the study, or an edge of its band.
inline const Pen kThreshold{colour::kBlack, Dash::dashed, Mark::none, 1.2};

/// What guessing would give.
inline const Pen kChance{colour::kGrey, Dash::dotted, Mark::none, 1.2};

}  // namespace mpm
