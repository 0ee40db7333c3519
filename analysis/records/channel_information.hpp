#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// What a record tells about gain, time constants and dead time of one channel. With the columns X of this
/// channel alone and the noise v of ChannelErrorFit, the information is X' X / v. An eigenvalue above 1
/// belongs to a combination of the three that the record tells better than it was known before.
struct ChannelInformation {
  Eigen::Index parameters = 0;  ///< p: 3, or 2 for a channel without lag
  Eigen::Index rank = 0;        ///< eigenvalues above 1
  /// Condition number of X' X with columns of length 1: 1 if each parameter acts in its own way, infinite if
  /// a combination of them does nothing.
  double condition = 0.0;
  /// The parameters that take part in the combination with the smallest effect.
  std::vector<MismatchParameter> alike = {};
};

/// `share`: standard deviation of errors of the model. Throws InputError if no two samples of the CV follow
/// each other.
ChannelInformation channel_information(const Study& study, const AssessedLoop& loop, const Channel& channel,
                                       double share);

}  // namespace mpm
