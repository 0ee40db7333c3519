#pragma once

#include <Eigen/Core>

namespace mpm {

/// The fewest samples from one that is there to the next: 1 for most signals, the period of an analyser for
/// what it measures. NaN: a sample that is missing. The length of a signal of which fewer than two are there.
Eigen::Index sample_spacing(const Eigen::Ref<const Eigen::VectorXd>& signal);

}  // namespace mpm
