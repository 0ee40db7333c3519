#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "base/row_major.hpp"

namespace mpm {

/// Rows first .. first + count - 1 of a matrix, and the columns that are not zero in all of them, in
/// increasing order: those of a CV that answers to some of the MVs only.
struct RowBand {
  Eigen::Index first, count;
  std::vector<int> columns;

  Eigen::Index end() const { return first + count; }
  Eigen::Index width() const { return static_cast<Eigen::Index>(columns.size()); }
};

/// The most columns of a band that is not the whole matrix.
inline constexpr std::size_t kWidestBand = 512;

/// The rows of a matrix as bands, in their order; as a single one with all columns where that is hardly more
/// work.
std::vector<RowBand> row_bands(const RowMajorMatrix& rows);

}  // namespace mpm
