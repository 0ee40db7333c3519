#pragma once

#include <Eigen/Core>

namespace mpm {

/// A dense matrix whose rows are contiguous: the order of a file, of what runs along the samples of one row,
/// and of the rows of a program.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace mpm
