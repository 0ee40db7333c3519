#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/random/random_stream.hpp"
#include "scenarios/study/study.hpp"

// The parts of draw_experiment(): each fills in its fault. `draw` has its index and its kind.

namespace mpm {

/// A place drawn with these relative frequencies; takes one value from the stream.
std::size_t draw_place(std::span<const double> weights, RandomStream& stream);

/// The channels from MVs to CVs, row by row. Errors: InputError where there is none.
std::vector<ChannelPlace> mv_channels(const Study& study);
/// Those that random mismatches of the study change.
std::vector<ChannelPlace> mismatch_channels(const Study& study);
/// The CVs on which random disturbances of the study act.
std::vector<Eigen::Index> disturbance_cvs(const Study& study);

/// The mismatches, or the changed parameters of a nonlinear plant with the CVs that they affect.
void draw_mismatch(const Study& study, ExperimentDraw& draw);

/// The disturbances, the first one on the CV of the mismatch where there is one.
void draw_disturbance(const Study& study, ExperimentDraw& draw);

/// The other fault, with the CVs that it affects.
void draw_other_fault(const Study& study, ExperimentDraw& draw);

/// The value of a parameter of the nonlinear plant of the study that its model rests on.
double nominal_value(const Study& study, std::string_view parameter);

Onset draw_onset(const Study& study, std::int64_t index);

/// Relative frequencies of the other faults, 0 for those that the loops of the study cannot have: without MDs
/// that move there is no wrong measurement of one, without soft limits none that is changed.
std::array<double, kOtherFaultKinds.size()> other_weights(const Study& study);

}  // namespace mpm
