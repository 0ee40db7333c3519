#pragma once

#include <Eigen/Core>

namespace mpm {

/// A dense matrix whose rows are contiguous. This is the order of a file, of computations along the samples
/// of one row, and of the rows of an optimization problem.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace mpm
