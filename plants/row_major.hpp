#pragma once

#include <Eigen/Core>

namespace mpm {

/// The order of a file, and what runs along the samples of one row at a time.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace mpm
