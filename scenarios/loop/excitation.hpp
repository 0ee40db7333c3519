#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "scenarios/study/study.hpp"

namespace mpm {

/// The measured disturbances of the study as listed steps, which no longer depend on its seed.
std::vector<SignalStep> as_steps(const Eigen::MatrixXd& d);

/// The study with the excitation of experiment `index`. With SignalSequence::shared it is the study itself.
/// Otherwise it lists the whole excitation of this experiment, with SignalSequence::shared. The nominal loop
/// (kBasisIndex) has the signals of the study as they are.
///
/// Random steps and the variation of the MDs are drawn from the streams of the experiment. Listed steps of
/// each MD, setpoint and soft limit come in a new order and at new times. The times are sorted uniform draws
/// between half of the first listed sample and the midpoint of the last listed sample and the end of the
/// record. The levels of MDs and setpoints are drawn between half of the listed move from the start and all
/// of it. Two steps of a variable never share a sample. The source of the study is unchanged.
Study with_excitation(const Study& study, std::int64_t index);

}  // namespace mpm
