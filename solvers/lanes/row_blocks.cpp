#include "solvers/lanes/row_blocks.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/lanes/row_basis.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kBlock = 8;
constexpr Eigen::Index kMostCoordinates = 512;  // rows of all bases, whose products stand on the stack

/// True when row i + 1 is row i moved by a period, except for the first and the last columns.
bool follows(const RowMajorMatrix& rows, Eigen::Index i, Eigen::Index period) {
  const Eigen::Index count = rows.cols() - 2 * period;
  return std::equal(rows.row(i).data(), rows.row(i).data() + count, rows.row(i + 1).data() + period);
}

/// Numbers first, first + 1, ...
std::vector<int> numbered(Eigen::Index count, Eigen::Index first = 0) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), static_cast<int>(first));
  return numbers;
}

Eigen::Index blocks_of(Eigen::Index rows) {
  return padded(rows) / kBlock;
}

}  // namespace

// Rows beyond the last one are zero.
RowBlocks::Blocks RowBlocks::make_blocks(const RowMajorMatrix& rows, Eigen::Index first, Eigen::Index last,
                                         std::vector<int> columns) {
  Blocks blocks{first, std::move(columns), blocks_of(last - first)};
  for (Eigen::Index block = first; block < last; block += kBlock)
    for (const int j : blocks.columns)
      for (Eigen::Index i = block; i < block + kBlock; ++i)
        blocks.numbers.push_back(i < rows.rows() ? rows(i, j) : 0.0);
  return blocks;
}

void RowBlocks::Blocks::multiply(const double* x, double* out) const {
  lane_kernels().multiply_some(numbers.data(), columns.data(), static_cast<long>(columns.size()), count, x,
                               out + first);
}

// Finds the runs that are at least as long as the windows, which end with the moves.
std::vector<RowBlocks::Run> RowBlocks::find_runs(const RowMajorMatrix& rows, Eigen::Index period) {
  std::vector<Run> runs;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (i > 0 && follows(rows, i - 1, period))
      runs.back().last = i + 1;
    else
      runs.push_back({i, i + 1});
  std::erase_if(runs, [&](const Run& run) { return run.last - run.first < padded(rows.cols() / period); });
  return runs;
}

// Finds the period with the most rows in runs; 0 if there is none. With fewer than four groups of columns
// nothing is gained.
Eigen::Index RowBlocks::find_period(const RowMajorMatrix& rows) {
  Eigen::Index best = 0;
  Eigen::Index most = 0;
  for (Eigen::Index period = 1; 4 * period <= rows.cols(); ++period) {
    if (rows.cols() % period != 0)
      continue;
    Eigen::Index count = 0;
    for (const Run& run : find_runs(rows, period))
      count += run.last - run.first;
    if (count > most) {
      most = count;
      best = period;
    }
  }
  return best;
}

RowBlocks::RowBlocks(const RowMajorMatrix& rows) {
  std::vector<Run> runs;
  if (const Eigen::Index period = find_period(rows); period > 0) {
    runs = find_runs(rows, period);
    window_blocks_ = blocks_of(rows.cols() / period);
    add_windows(rows, period, runs);
  } else {
    order_ = numbered(rows.cols());
  }
  add_whole(rows, runs);
  add_late(rows, runs);
}

// In a block, the window of move i + 8 is that of move i in the block before. Such pairs share it.
void RowBlocks::add_taps(Eigen::Index period, Eigen::Index moves, Eigen::Index length) {
  std::vector<RowTap> single;
  for (Eigen::Index j = 0; j < period; ++j) {
    for (Eigen::Index i = 0; i < moves; ++i) {
      if (i % (2 * kBlock) >= kBlock)
        continue;  // a partner
      const RowTap tap{j * length + moves - 1 - i, static_cast<int>(i * period + j),
                       static_cast<int>((i + kBlock) * period + j)};
      (i + kBlock < moves ? taps_ : single).push_back(tap);
    }
    single.push_back({(period + j) * length + moves - 1, static_cast<int>(moves * period + j), 0});
  }
  pairs_ = static_cast<long>(taps_.size());
  for (const RowTap& tap : taps_)
    order_.insert(order_.end(), {tap.column, tap.partner});
  for (const RowTap& tap : single)
    order_.push_back(tap.column);
  taps_.insert(taps_.end(), single.begin(), single.end());
}

// A series of a run is as long as its blocks and its number of columns require. Number t of the series, which
// stands at t + moves - 1, is what the column of the first move has in row t of the run.
void RowBlocks::add_windows(const RowMajorMatrix& rows, Eigen::Index period, const std::vector<Run>& runs) {
  const Eigen::Index moves = rows.cols() / period - 1;
  const Eigen::Index count = kBlock * window_blocks_;
  const Eigen::Index length = moves - 1 + count;
  add_taps(period, moves, length);
  numbers_.assign(runs.size() * static_cast<std::size_t>(2 * period * length), 0.0);
  double* numbers = numbers_.data();
  for (const Run& run : runs) {
    for (Eigen::Index j = 0; j < period; ++j) {
      double* first = numbers + j * length + moves - 1;
      double* last = first + period * length;
      for (Eigen::Index t = 0; t < count; ++t) {
        first[t] = rows(run.first + t, j);
        last[t] = rows(run.first + t, moves * period + j);
      }
      for (Eigen::Index t = 1; t < moves; ++t)
        first[-t] = rows(run.first, t * period + j);
    }
    starts_.push_back(numbers - numbers_.data());
    window_rows_.push_back(run.first);
    numbers += 2 * period * length;
  }
}

// Rows that are in no run, in blocks that begin at multiples of eight. If a block includes rows of a run, the
// run writes these again.
void RowBlocks::add_whole(const RowMajorMatrix& rows, const std::vector<Run>& runs) {
  Eigen::Index first = 0;
  for (const Run& run : runs) {
    if (first < run.first)
      whole_.push_back(make_blocks(rows, first / kBlock * kBlock, run.first, order_));
    first = run.last;
  }
  if (first < rows.rows())
    whole_.push_back(make_blocks(rows, first / kBlock * kBlock, rows.rows(), order_));
}

// The rows of the runs after their windows, in blocks that reach back from the end of the run: as P and Q if
// that is less work, otherwise as they are.
void RowBlocks::add_late(const RowMajorMatrix& rows, const std::vector<Run>& runs) {
  RowMajorMatrix all(0, rows.cols());
  for (const Run& run : runs) {
    const Eigen::Index count = run.last - run.first - kBlock * window_blocks_;
    const Eigen::Index blocks = blocks_of(count);
    const Eigen::Index first = run.last - kBlock * blocks;
    const Eigen::Index worth = (kBlock * blocks * rows.cols() - 1) / (kBlock * blocks + rows.cols());
    const auto basis =
        row_basis(rows.middleRows(run.last - count, count), std::min(worth, kMostCoordinates - all.rows()));
    if (!basis) {
      whole_.push_back(make_blocks(rows, first, run.last, order_));
      continue;
    }
    const RowMajorMatrix parts = rows.middleRows(first, kBlock * blocks) * basis->transpose();
    late_.push_back(make_blocks(parts, 0, parts.rows(), numbered(basis->rows())));
    late_.back().first = first;
    late_.back().columns = numbered(basis->rows(), all.rows());
    all.conservativeResize(all.rows() + basis->rows(), Eigen::NoChange);
    all.bottomRows(basis->rows()) = *basis;
  }
  basis_ = make_blocks(all, 0, all.rows(), numbered(rows.cols()));
}

Eigen::Index RowBlocks::late_row_count() const {
  return std::accumulate(late_.begin(), late_.end(), Eigen::Index{0},
                         [](Eigen::Index sum, const Blocks& late) { return sum + kBlock * late.count; });
}

std::size_t RowBlocks::number_count() const {
  std::size_t count = numbers_.size() + basis_.numbers.size();
  for (const std::vector<Blocks>* list : {&whole_, &late_})
    for (const Blocks& blocks : *list)
      count += blocks.numbers.size();
  return count;
}

// The ends of blocks may be written twice; the value that is written last is right.
void RowBlocks::multiply(const double* x, LaneVector& out) const {
  for (const Blocks& blocks : whole_)
    blocks.multiply(x, out.data());
  alignas(64) double coordinates[kMostCoordinates];
  basis_.multiply(x, coordinates);
  for (const Blocks& late : late_)
    late.multiply(coordinates, out.data());
  lane_kernels().multiply({.numbers = numbers_.data(),
                           .taps = taps_.data(),
                           .pair_count = pairs_,
                           .tap_count = static_cast<long>(taps_.size()),
                           .blocks = window_blocks_,
                           .starts = starts_.data(),
                           .rows = window_rows_.data(),
                           .run_count = static_cast<long>(starts_.size())},
                          x, out.data());
}

}  // namespace mpm
