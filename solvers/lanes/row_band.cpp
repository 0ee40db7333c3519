#include "solvers/lanes/row_band.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace mpm {
namespace {

// Share of all numbers that bands may keep: if they keep more, gathering costs more than it saves.
constexpr double kWorthwhile = 0.6;

// A band goes on as long as its columns include those of the next row or the other way round: the later rows
// of a CV answer to all moves, the first ones to some.
void add_row(std::vector<RowBand>& bands, Eigen::Index row, std::vector<int> columns) {
  if (!bands.empty()) {
    RowBand& last = bands.back();
    const bool grows = std::ranges::includes(columns, last.columns);
    if (grows || std::ranges::includes(last.columns, columns)) {
      if (grows)
        last.columns = std::move(columns);
      ++last.count;
      return;
    }
  }
  bands.push_back({row, 1, std::move(columns)});
}

}  // namespace

std::vector<RowBand> row_bands(const RowMajorMatrix& rows) {
  std::vector<RowBand> bands;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    std::vector<int> columns;
    for (Eigen::Index j = 0; j < rows.cols(); ++j)
      if (rows(i, j) != 0.0)
        columns.push_back(static_cast<int>(j));
    add_row(bands, i, std::move(columns));
  }
  double kept = 0.0;
  std::size_t widest = 0;
  for (const RowBand& band : bands) {
    kept += static_cast<double>(band.count * band.width());
    widest = std::max(widest, band.columns.size());
  }
  if (widest <= kWidestBand && kept <= kWorthwhile * static_cast<double>(rows.size()))
    return bands;
  std::vector<int> all(static_cast<std::size_t>(rows.cols()));
  std::iota(all.begin(), all.end(), 0);
  return {{0, rows.rows(), std::move(all)}};
}

}  // namespace mpm
