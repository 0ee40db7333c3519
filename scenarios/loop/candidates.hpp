#pragma once

#include <Eigen/Core>

#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

// Signals that a historian keeps beside those of the loop, and that neither controller nor model know
// (study.record.candidates): one of them may drive the disturbance, the others are decoys. They do not change
// any loop.

namespace mpm {

/// Which candidate is the signal v of the first disturbance of the experiment; -1 for none: the experiment
/// has no disturbance, its cause is not logged, or there are no candidates.
Eigen::Index true_candidate(const Study& study, const ExperimentDraw& draw);

/// The candidates of the experiment, one row each and one column a sample; 0 x 0 without any.
/// true_candidate() is v as it is before the onset, too, when it does not act yet. A decoy has the form of v
/// and random numbers of its own, so that only its effect distinguishes it from the cause; it is white noise
/// where v is no random signal, or the experiment has no disturbance. A pure function of its arguments.
Eigen::MatrixXd logged_candidates(const Study& study, const ExperimentDraw& draw);

}  // namespace mpm
