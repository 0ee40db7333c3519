#pragma once

#include <Eigen/Core>

#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

// Signals that a historian keeps beside those of the loop, and that neither the controller nor the model
// knows (study.record.candidates). One of them may drive the disturbance; the others are decoys. They do not
// change any loop.

namespace mpm {

/// The candidate that is the signal v of the first disturbance of the experiment; -1 if the experiment has no
/// disturbance, its cause is not logged, or there are no candidates.
Eigen::Index true_candidate(const Study& study, const ExperimentDraw& draw);

/// The candidates of the experiment, one row a candidate and one column a sample; 0 x 0 if there are none.
/// Row true_candidate() is v over the whole record, even before the onset, when it does not act yet. A decoy
/// has the form of v and random numbers of its own, so that only its effect distinguishes the cause from it.
/// If v is not a random signal or the experiment has no disturbance, a decoy is white noise. A pure function
/// of its arguments.
Eigen::MatrixXd logged_candidates(const Study& study, const ExperimentDraw& draw);

}  // namespace mpm
