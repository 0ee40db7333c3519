#include "solvers/lanes/row_blocks.hpp"

#include <algorithm>

#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/lanes/lane_kernels.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kBlock = 8;

/// True when row i + 1 is row i moved by a period, but for the first and the last columns.
bool follows(const RowBlocks::Rows& rows, Eigen::Index i, Eigen::Index period) {
  const Eigen::Index count = rows.cols() - 2 * period;
  return std::equal(rows.row(i).data(), rows.row(i).data() + count, rows.row(i + 1).data() + period);
}

/// Blocks of eight rows within the rows first to last - 1.
Eigen::Index first_block(Eigen::Index first) {
  return padded(first) / kBlock;
}
Eigen::Index end_block(Eigen::Index last) {
  return last / kBlock;
}

}  // namespace

std::vector<RowBlocks::Run> RowBlocks::find_runs(const Rows& rows, Eigen::Index period) {
  std::vector<Run> runs;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (i > 0 && follows(rows, i - 1, period))
      runs.back().last = i + 1;
    else
      runs.push_back({i, i + 1});
  std::erase_if(runs, [](const Run& run) { return first_block(run.first) >= end_block(run.last); });
  return runs;
}

RowBlocks::RowBlocks(const Rows& rows) {
  // The period that leaves the fewest numbers; with fewer than four groups of columns nothing is gained.
  Eigen::Index best = 0;
  Eigen::Index most = 0;
  for (Eigen::Index period = 1; 4 * period <= rows.cols(); ++period) {
    if (rows.cols() % period != 0)
      continue;
    Eigen::Index blocks = 0;
    for (const Run& run : find_runs(rows, period))
      blocks += end_block(run.last) - first_block(run.first);
    if (blocks > most) {
      most = blocks;
      best = period;
    }
  }
  if (best > 0)
    add_windows(rows, best, find_runs(rows, best));
  add_whole(rows);
}

// A series of a run is as long as the longest run and the number of its columns ask for; number t of it,
// which stands at t + moves - 1, is what the column of the first move has in row t of the run.
void RowBlocks::add_windows(const Rows& rows, Eigen::Index period, const std::vector<Run>& runs) {
  const Eigen::Index moves = rows.cols() / period - 1;
  Eigen::Index longest = 0;
  for (const Run& run : runs)
    longest = std::max(longest, run.last - run.first);
  const Eigen::Index length = moves - 1 + longest;
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    const bool last = j >= moves * period;
    const Eigen::Index series = last ? j % period + period : j % period;
    windows_.offset.push_back(series * length + moves - 1 - (last ? 0 : j / period));
  }
  windows_.numbers.assign(runs.size() * static_cast<std::size_t>(2 * period * length), 0.0);
  double* numbers = windows_.numbers.data();
  for (const Run& run : runs) {
    for (Eigen::Index j = 0; j < period; ++j) {
      double* first = numbers + j * length + moves - 1;
      double* last = first + period * length;
      for (Eigen::Index t = 0; t < run.last - run.first; ++t) {
        first[t] = rows(run.first + t, j);
        last[t] = rows(run.first + t, moves * period + j);
      }
      for (Eigen::Index t = 1; t < moves; ++t)
        first[-t] = rows(run.first, t * period + j);
    }
    for (Eigen::Index block = first_block(run.first); block < end_block(run.last); ++block) {
      windows_.start.push_back(numbers - windows_.numbers.data() + block * kBlock - run.first);
      windows_.row.push_back(block * kBlock);
    }
    numbers += 2 * period * length;
  }
}

// What has no windows, a block column by column.
void RowBlocks::add_whole(const Rows& rows) {
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    whole_.offset.push_back(j * kBlock);
  for (Eigen::Index first = 0; first < rows.rows(); first += kBlock) {
    if (std::binary_search(windows_.row.begin(), windows_.row.end(), first))
      continue;
    whole_.start.push_back(static_cast<long>(whole_.numbers.size()));
    whole_.row.push_back(first);
    for (Eigen::Index j = 0; j < rows.cols(); ++j)
      for (Eigen::Index i = first; i < first + kBlock; ++i)
        whole_.numbers.push_back(i < rows.rows() ? rows(i, j) : 0.0);
  }
}

void RowBlocks::multiply(const double* x, LaneVector& out) const {
  windows_.multiply(x, out);
  whole_.multiply(x, out);
}

void RowBlocks::Set::multiply(const double* x, LaneVector& out) const {
  lane_kernels().multiply({.numbers = numbers.data(),
                           .columns = static_cast<long>(offset.size()),
                           .offset = offset.data(),
                           .blocks = static_cast<long>(start.size()),
                           .start = start.data(),
                           .row = row.data()},
                          x, out.data());
}

}  // namespace mpm
