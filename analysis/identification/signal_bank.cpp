#include "analysis/identification/signal_bank.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

/// The coefficients of the signals of one group: eight numbers a row, zeros for signals that there are not.
LaneMatrix coefficients(const Eigen::Ref<const Eigen::MatrixXd>& polynomials, Eigen::Index group) {
  LaneMatrix rows(8, polynomials.rows());
  const Eigen::Index signals = std::min<Eigen::Index>(8, polynomials.cols() - 8 * group);
  for (Eigen::Index i = 0; i < polynomials.rows(); ++i)
    for (Eigen::Index a = 0; a < signals; ++a)
      rows(a, i) = polynomials(i, 8 * group + a);
  return rows;
}

/// Fills block (row, column) of the products of two groups of columns.
void add_products(const ShiftedSignals& signals, const LaggedColumns& a, const LaggedColumns& b,
                  Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> block) {
  const LaneKernels& kernels = lane_kernels();
  const Eigen::Index n = signals.samples() - first;
  const double* x = signals.data(a.signal) + first - a.lag;
  const double* y = signals.data(b.signal) + first - b.lag;
  Eigen::VectorXd sums(std::max(a.count, b.count));
  kernels.lag_sums(x, y, n, b.count, sums.data());
  block.row(0) = sums.head(b.count).transpose();
  kernels.lag_sums(y, x, n, a.count, sums.data());
  block.col(0) = sums.head(a.count);
  for (Eigen::Index j = 1; j < b.count; ++j)
    for (Eigen::Index i = 1; i < a.count; ++i)
      block(i, j) = block(i - 1, j - 1) + x[-i] * y[-j] - x[n - i] * y[n - j];
}

}  // namespace

SignalBank::SignalBank(Eigen::Index count, Eigen::Index samples, Eigen::Index memory)
    : count_(count),
      samples_(samples),
      memory_(memory),
      memory_of_(static_cast<std::size_t>((count + 7) / 8 * 8 * (memory + samples)), 0.0) {}

void filter_bank(const Eigen::Ref<const Eigen::MatrixXd>& B, const Eigen::Ref<const Eigen::MatrixXd>& F,
                 Eigen::Index delay, const SignalBank& in, SignalBank& out) {
  assert(B.cols() == in.count() && F.cols() == in.count() && out.count() == in.count());
  assert(in.memory() >= B.rows() - 1 + delay && out.memory() >= F.rows() - 1);
  for (Eigen::Index group = 0; 8 * group < in.count(); ++group) {
    const LaneMatrix numerators = coefficients(B, group);
    const LaneMatrix denominators = coefficients(F, group);
    lane_kernels().filter_eight(numerators.data(), B.rows(), denominators.data(), F.rows() - 1,
                                in.at(group, -delay), in.samples(), out.at(group, 0));
  }
}

ShiftedSignals::ShiftedSignals(Eigen::Index count, Eigen::Index samples, Eigen::Index memory)
    : memory_(memory), values_(Eigen::MatrixXd::Zero(memory + samples, count)) {}

Eigen::Index column_count(const std::vector<LaggedColumns>& columns) {
  Eigen::Index count = 0;
  for (const LaggedColumns& group : columns)
    count += group.count;
  return count;
}

Eigen::MatrixXd lagged_matrix(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                              Eigen::Index first) {
  const Eigen::Index n = signals.samples() - first;
  Eigen::MatrixXd X(n, column_count(columns));
  Eigen::Index column = 0;
  for (const LaggedColumns& group : columns)
    for (Eigen::Index i = 0; i < group.count; ++i)
      X.col(column++) =
          Eigen::Map<const Eigen::VectorXd>(signals.data(group.signal) + first - group.lag - i, n);
  return X;
}

Eigen::MatrixXd lagged_products(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                                Eigen::Index first) {
  Eigen::MatrixXd products(column_count(columns), column_count(columns));
  Eigen::Index row = 0;
  for (std::size_t a = 0; a < columns.size(); row += columns[a++].count) {
    Eigen::Index column = row;
    for (std::size_t b = a; b < columns.size(); column += columns[b++].count) {
      auto block = products.block(row, column, columns[a].count, columns[b].count);
      add_products(signals, columns[a], columns[b], first, block);
      if (b > a)
        products.block(column, row, columns[b].count, columns[a].count) = block.transpose();
    }
  }
  return products;
}

Eigen::VectorXd lagged_products_with(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                                     Eigen::Index with, Eigen::Index first) {
  Eigen::VectorXd products(column_count(columns));
  Eigen::Index row = 0;
  for (const LaggedColumns& group : columns) {
    lane_kernels().lag_sums(signals.data(with) + first, signals.data(group.signal) + first - group.lag,
                            signals.samples() - first, group.count, products.data() + row);
    row += group.count;
  }
  return products;
}

}  // namespace mpm
