#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "base/row_major.hpp"

namespace mpm {

/// Rows first .. first + count - 1 of a matrix, and the columns in which some of them are not zero, in
/// increasing order: those of a CV that answers to some of the MVs only.
struct RowBand {
  Eigen::Index first, count;
  std::vector<int> columns;

  Eigen::Index end() const { return first + count; }
  Eigen::Index width() const { return static_cast<Eigen::Index>(columns.size()); }
};

/// Most columns of a band, unless the band is the whole matrix.
inline constexpr std::size_t kWidestBand = 512;

/// Divides the rows of a matrix into bands, in their order. Returns a single band with all columns if that is
/// hardly more work.
std::vector<RowBand> row_bands(const RowMajorMatrix& rows);

}  // namespace mpm
