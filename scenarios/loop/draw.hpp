#pragma once

#include <cstdint>

#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Draws experiment `index` of the study, with the scales 1: a pure function of (study, seed, index). In a
/// random experiment with mismatch and disturbance, the first mismatch and the first disturbance are on the
/// same CV, as (6.23) needs, unless the disturbance is on an MV or the plant is nonlinear. Throws InputError
/// for a negative index and, in a study of named scenarios, for an index without a scenario.
ExperimentDraw draw_experiment(const Study& study, std::int64_t index);

/// The experiment `draw`, which has the scales 1, with its faults scaled by `scales`.
ExperimentDraw with_scales(const Study& study, ExperimentDraw draw, const FaultScales& scales);

/// The basis case, without a fault. In a world it is the benchmark that the methods know, with noise and
/// background of its own.
ExperimentDraw basis_draw(int world = kExactWorld);

/// The study with the controller that runs in the experiment: `study` itself unless the draw changes its
/// tuning. simulate_experiment() does this itself: do not pass it the result, which would change the tuning
/// twice. Throws InputError for a weight that the controller does not have.
Study with_tuning(const Study& study, const ExperimentDraw& draw);

}  // namespace mpm
