#pragma once

#include <Eigen/Core>

namespace mpm {

/// The smallest distance between two samples that are not missing: 1 for most signals, the period of an
/// analyser for its signal. NaN: a sample that is missing. The length of a signal of which fewer than two are
/// there.
Eigen::Index sample_spacing(const Eigen::Ref<const Eigen::VectorXd>& signal);

}  // namespace mpm
