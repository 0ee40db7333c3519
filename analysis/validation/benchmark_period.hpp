#pragma once

#include <utility>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"

namespace mpm {

/// The period of `samples` samples of a record in which the model is best, for methods that compare with a
/// benchmark: the one with the least
///
///   sum_i log( mean (y_i - y_sim,i - mean)^2 / m_i ),
///
/// m_i the same over the whole record, over the CVs i that have half of their samples in the period. It is
/// the logarithm of the volume det(cov e) of Yu and Qin (2.13), which their benchmark index compares, of the
/// simulation errors e and without their correlations; it does not depend on units, and a disturbance or a
/// mismatch that moves makes it larger. Nothing says that this period is good: only that no other one of the
/// record is better.
///
/// First sample and the one after the last; of equal ones the earliest. Equal numbers: no CV has enough
/// samples in any period, or the record is shorter.
std::pair<Eigen::Index, Eigen::Index> quietest_period(const AssessedLoop& loop, Eigen::Index samples);

}  // namespace mpm
