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

// The parts of draw_experiment(): each fills in its fault. `draw` already has its index and its kind.

namespace mpm {

/// Draws an index with these relative frequencies; takes one value from the stream.
std::size_t draw_place(std::span<const double> weights, RandomStream& stream);

/// The channels from MVs to CVs, row by row. Errors: InputError if there is none.
std::vector<ChannelPlace> mv_channels(const Study& study);
/// The channels that random mismatches of the study change.
std::vector<ChannelPlace> mismatch_channels(const Study& study);
/// The CVs on which random disturbances of the study act.
std::vector<Eigen::Index> disturbance_cvs(const Study& study);

/// Draws the mismatches, or the changed parameters of a nonlinear plant with the CVs that they affect.
void draw_mismatch(const Study& study, ExperimentDraw& draw);

/// Draws the disturbances; the first one is on the CV of the first mismatch if there is one.
void draw_disturbance(const Study& study, ExperimentDraw& draw);

/// Draws the other fault, with the CVs that it affects.
void draw_other_fault(const Study& study, ExperimentDraw& draw);

/// The nominal value of a parameter of the nonlinear plant, on which the model of the study is based.
double nominal_value(const Study& study, std::string_view parameter);

Onset draw_onset(const Study& study, std::int64_t index);

/// Relative frequencies of the other faults, 0 for those that the loops of the study cannot have: an MD whose
/// measurement is wrong must move, and a limit that is changed must exist.
std::array<double, kOtherFaultKinds.size()> other_weights(const Study& study);

}  // namespace mpm
