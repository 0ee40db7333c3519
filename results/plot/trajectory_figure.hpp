#pragma once

#include <string>

#include "analysis/sensitivity/nominal_output.hpp"
#include "results/plot/figure.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Makes a figure of one closed loop, with one panel per variable (6.7 to 6.9 of the thesis): CVs y with
/// their nominal outputs y0 and their soft and hard limits, MVs with their targets and hard limits, and
/// measured disturbances. Only the samples that the controller finished are drawn.
///
/// `name` becomes the name of the figure. `nominal.y0` must have the shape of `loop.y`.
Figure trajectory_figure(const Study& study, const Trajectory& loop, const NominalOutputs& nominal,
                         const std::string& name);

}  // namespace mpm
