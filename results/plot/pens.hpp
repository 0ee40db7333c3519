#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "results/plot/figure.hpp"

namespace mpm {

/// Returns the pen of a CV in every panel. CVs differ in colour and, when the colours are used up, in dash. A
/// panel draws the CV that it is about `thick`.
Pen cv_pen(Eigen::Index cv, bool thick = false);

/// Returns the pen of a method among others: 21 methods differ in colour, and neighbours also in dash and
/// mark.
Pen method_pen(std::size_t method);

/// The pen of a threshold of the study, or of an edge of its band.
inline const Pen kThreshold{colour::kBlack, Dash::dashed, Mark::none, 1.2};

/// The pen of what guessing would give.
inline const Pen kChance{colour::kGrey, Dash::dotted, Mark::none, 1.2};

}  // namespace mpm
