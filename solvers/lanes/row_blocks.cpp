#include "solvers/lanes/row_blocks.hpp"

#include <algorithm>
#include <numeric>

#include "solvers/lanes/kernel_choice.hpp"

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

// The window of move i + 8 in a block is that of move i in the block before: such pairs share it.
void RowBlocks::add_taps(Eigen::Index period, Eigen::Index moves, Eigen::Index length) {
  std::vector<RowTap> single;
  for (Eigen::Index j = 0; j < period; ++j) {
    for (Eigen::Index i = 0; i < moves; ++i) {
      if (i % (2 * kBlock) >= kBlock)
        continue;  // a partner
      const RowTap tap{j * length + moves - 1 - i, static_cast<int>(i * period + j),
                       static_cast<int>((i + kBlock) * period + j)};
      (i + kBlock < moves ? windows_.taps : single).push_back(tap);
    }
    single.push_back({(period + j) * length + moves - 1, static_cast<int>(moves * period + j), 0});
  }
  windows_.pairs = static_cast<long>(windows_.taps.size());
  windows_.taps.insert(windows_.taps.end(), single.begin(), single.end());
}

// A series of a run is as long as the longest run and the number of its columns ask for; number t of it,
// which stands at t + moves - 1, is what the column of the first move has in row t of the run.
void RowBlocks::add_windows(const Rows& rows, Eigen::Index period, const std::vector<Run>& runs) {
  const Eigen::Index moves = rows.cols() / period - 1;
  Eigen::Index longest = 0;
  for (const Run& run : runs)
    longest = std::max(longest, run.last - run.first);
  const Eigen::Index length = moves - 1 + longest;
  add_taps(period, moves, length);
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
    const Eigen::Index block = first_block(run.first);
    const Eigen::Index count = end_block(run.last) - block;
    windows_.runs.push_back({numbers - windows_.numbers.data() + block * kBlock - run.first, kBlock, count});
    for (Eigen::Index k = 0; k < count; ++k)
      windows_.row.push_back((block + k) * kBlock);
    numbers += 2 * period * length;
  }
}

// What has no windows, a block column by column.
void RowBlocks::add_whole(const Rows& rows) {
  std::vector<int> order = column_order();
  if (order.empty()) {
    order.resize(static_cast<std::size_t>(rows.cols()));
    std::iota(order.begin(), order.end(), 0);
  }
  for (const int j : order)
    whole_.taps.push_back({kBlock * static_cast<long>(whole_.taps.size()), j, 0});
  for (Eigen::Index first = 0; first < rows.rows(); first += kBlock) {
    if (std::binary_search(windows_.row.begin(), windows_.row.end(), first))
      continue;
    whole_.row.push_back(first);
    for (const int j : order)
      for (Eigen::Index i = first; i < first + kBlock; ++i)
        whole_.numbers.push_back(i < rows.rows() ? rows(i, j) : 0.0);
  }
  whole_.runs.push_back({0, kBlock * rows.cols(), static_cast<long>(whole_.row.size())});
}

std::vector<int> RowBlocks::column_order() const {
  const Set& set = windows_.taps.empty() ? whole_ : windows_;
  std::vector<int> order;
  for (const RowTap& tap : set.taps) {
    order.push_back(tap.column);
    if (&tap < set.taps.data() + set.pairs)
      order.push_back(tap.partner);
  }
  return order;
}

void RowBlocks::multiply(const double* x, LaneVector& out) const {
  windows_.multiply(x, out);
  whole_.multiply(x, out);
}

void RowBlocks::Set::multiply(const double* x, LaneVector& out) const {
  lane_kernels().multiply({.numbers = numbers.data(),
                           .taps = taps.data(),
                           .pair_count = pairs,
                           .tap_count = static_cast<long>(taps.size()),
                           .runs = runs.data(),
                           .run_count = static_cast<long>(runs.size()),
                           .row = row.data()},
                          x, out.data());
}

}  // namespace mpm
