#pragma once

#include <Eigen/Core>

namespace mpm {

/// Returns the smallest distance between two samples that are not missing (NaN): 1 for most signals, the
/// period of an analyser for its signal. If fewer than two samples are present, returns the length of the
/// signal.
Eigen::Index sample_spacing(const Eigen::Ref<const Eigen::VectorXd>& signal);

}  // namespace mpm
