#include "analysis/identification/lag_sums.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kHalf = 4;

}  // namespace

Eigen::Index column_count(const std::vector<LaggedColumns>& columns) {
  Eigen::Index count = 0;
  for (const LaggedColumns& group : columns)
    count += group.count;
  return count;
}

Eigen::MatrixXd lagged_matrix(const SignalBank& signals, const std::vector<LaggedColumns>& columns,
                              Eigen::Index first) {
  const Eigen::Index n = signals.samples() - first;
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(n, column_count(columns));
  Eigen::Index column = 0;
  for (const LaggedColumns& group : columns)
    for (Eigen::Index lag = group.lag; lag < group.lag + group.count; ++lag, ++column) {
      const Eigen::Index rest = std::max<Eigen::Index>(0, lag - first);  // before the record
      X.col(column).tail(n - rest) = signals[group.signal].segment(first - lag + rest, n - rest);
    }
  return X;
}

void LagSums::compute(const SignalBank& signals, Eigen::Index delayed, Eigen::Index largest_lag,
                      Eigen::Index first, LagPairs pairs) {
  pairs_ = pairs;
  lags_ = largest_lag + 1;
  groups_ = signals.groups();
  before_.setZero(lags_, delayed);
  last_.setZero(lags_, delayed);
  signals.require_memory(largest_lag + (pairs == LagPairs::partners ? 1 : 0) - first);
  for (Eigen::Index a = 0; a < delayed; ++a)
    for (Eigen::Index t = 1; t < lags_; ++t) {
      before_(t, a) = first >= t ? signals[a](first - t) : 0.0;
      last_(t, a) = signals.samples() >= t ? signals[a](signals.samples() - t) : 0.0;
    }
  if (pairs == LagPairs::all)
    add_all(signals, delayed, first);
  else
    add_partners(signals, first);
}

void LagSums::add_all(const SignalBank& signals, Eigen::Index delayed, Eigen::Index first) {
  const Eigen::Index block = 64 * lags_;
  sums_.resize(static_cast<std::size_t>(groups_ * groups_ * block));
  for (Eigen::Index g = 0; g < groups_; ++g)
    for (Eigen::Index h = 0; 8 * h < delayed; ++h)
      lane_kernels().lag_products(signals.at(g, first), signals.at(h, first), signals.samples() - first,
                                  std::min<Eigen::Index>(8, delayed - 8 * h), lags_,
                                  sums_.data() + (g * groups_ + h) * block);
}

void LagSums::add_partners(const SignalBank& signals, Eigen::Index first) {
  const Eigen::Index block = 8 * lags_;
  sums_.resize(static_cast<std::size_t>(2 * groups_ * block));
  for (Eigen::Index g = 0; g < groups_; ++g) {
    const double* from = signals.at(g, first);
    double* to = sums_.data() + 2 * g * block;
    lane_kernels().lane_products(from, from, signals.samples() - first, lags_, to);
    lane_kernels().lane_products(from, from - kHalf, signals.samples() - first, lags_, to + block);
  }
}

double LagSums::sum(Eigen::Index a, Eigen::Index b, Eigen::Index lag) const {
  return pairs_ == LagPairs::all ? sum_of_all(a, b, lag) : sum_of_partners(a, b, lag);
}

double LagSums::sum_of_all(Eigen::Index a, Eigen::Index b, Eigen::Index lag) const {
  const Eigen::Index block = (a / 8) * groups_ + b / 8;
  return sums_[static_cast<std::size_t>(((8 * block + b % 8) * lags_ + lag) * 8 + a % 8)];
}

/// In memory, the number half a group before that of a signal of the second half is its partner at the same
/// sample. For a signal of the first half it is its partner at the sample before.
double LagSums::sum_of_partners(Eigen::Index a, Eigen::Index b, Eigen::Index lag) const {
  const auto at = [&](Eigen::Index kind, Eigen::Index l, Eigen::Index lane) {
    return sums_[static_cast<std::size_t>(((2 * (a / 8) + kind) * lags_ + l) * 8 + lane % 8)];
  };
  assert(a == b || (a / 8 == b / 8 && (a - b) % kHalf == 0));
  if (a == b)
    return at(0, lag, a);
  if (a % 8 >= kHalf)
    return at(1, lag, a);
  return lag == 0 ? at(1, 0, b) : at(1, lag - 1, a);
}

double LagSums::product(Eigen::Index a, Eigen::Index lag_a, Eigen::Index b, Eigen::Index lag_b) const {
  if (lag_b < lag_a)
    return product(b, lag_b, a, lag_a);
  double total = sum(a, b, lag_b - lag_a);
  for (Eigen::Index t = 1; t <= lag_a; ++t)
    total += before_(t, a) * before_(lag_b - lag_a + t, b) - last_(t, a) * last_(lag_b - lag_a + t, b);
  return total;
}

void LagSums::fill(const LaggedColumns& a, const LaggedColumns& b, Eigen::Ref<Eigen::MatrixXd> block) const {
  for (Eigen::Index i = 0; i < a.count; ++i)
    block(i, 0) = product(a.signal, a.lag + i, b.signal, b.lag);
  for (Eigen::Index j = 1; j < b.count; ++j) {
    const double before = before_(b.lag + j, b.signal), last = last_(b.lag + j, b.signal);
    block(0, j) = product(a.signal, a.lag, b.signal, b.lag + j);
    for (Eigen::Index i = 1; i < a.count; ++i)
      block(i, j) =
          block(i - 1, j - 1) + before_(a.lag + i, a.signal) * before - last_(a.lag + i, a.signal) * last;
  }
}

Eigen::MatrixXd LagSums::products(const std::vector<LaggedColumns>& columns) const {
  Eigen::MatrixXd products(column_count(columns), column_count(columns));
  Eigen::Index row = 0;
  for (std::size_t a = 0; a < columns.size(); row += columns[a++].count) {
    Eigen::Index column = row;
    for (std::size_t b = a; b < columns.size(); column += columns[b++].count) {
      auto block = products.block(row, column, columns[a].count, columns[b].count);
      fill(columns[a], columns[b], block);
      if (b > a)
        products.block(column, row, columns[b].count, columns[a].count) = block.transpose();
    }
  }
  return products;
}

Eigen::VectorXd LagSums::products_with(const std::vector<LaggedColumns>& columns, Eigen::Index with) const {
  Eigen::VectorXd products(column_count(columns));
  Eigen::Index row = 0;
  for (const LaggedColumns& group : columns)
    for (Eigen::Index i = 0; i < group.count; ++i)
      products(row++) = sum(with, group.signal, group.lag + i);
  return products;
}

}  // namespace mpm
