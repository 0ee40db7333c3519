#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// What a record tells of gain, time constants and dead time of one channel. With X and the noise v of
/// ChannelErrorFit, of the columns of this channel alone, the information is X' X / v. An eigenvalue above 1
/// is a combination of them that the record tells better than it was known before.
struct ChannelInformation {
  Eigen::Index parameters = 0;  ///< p: 3, or 2 of a channel without lag
  Eigen::Index rank = 0;        ///< eigenvalues above 1
  /// Of X' X with columns of length 1: 1 where each acts in its own way; infinite where a combination does
  /// nothing.
  double condition = 0.0;
  /// What takes part in the combination that acts least.
  std::vector<MismatchParameter> alike = {};
};

/// `share`: standard deviation of errors of the model. Throws InputError if no two samples of the CV follow
/// each other.
ChannelInformation channel_information(const Study& study, const AssessedLoop& loop, const Channel& channel,
                                       double share);

}  // namespace mpm
