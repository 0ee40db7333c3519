#pragma once

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/cv_errors.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// A mismatch of one parameter of the channel from one input, MVs before MDs, and by how much it is likelier
/// than none beside noise of any shape (CvErrors): the gain of L, less k/2 log n for its k parameters
/// (Schwarz 1978).
struct LikelyMismatch {
  Eigen::Index place = -1;
  MismatchParameter parameter = MismatchParameter::gain;
  Eigen::Index onset = 0;
  double gain = -kInfinity;
};

/// The signal of an input, N of the loop.
Eigen::RowVectorXd input_of(const Study& study, const AssessedLoop& loop, Eigen::Index place);

/// The response of a channel to x, N of the loop. Before the loop, x rests at its first value.
Eigen::RowVectorXd response_of(const Study& study, const TransferFunction& channel,
                               const Eigen::RowVectorXd& x);

/// The best mismatch of a CV: a gain of 0.3 to 3.3 times that of the model, or a time constant or dead time
/// on a grid. It lasts throughout or begins at the sample from which a different gain explains most.
LikelyMismatch likely_mismatch(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                               Eigen::Index cv);

}  // namespace mpm
