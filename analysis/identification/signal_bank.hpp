#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/lanes/lane_vector.hpp"

// Many signals of one length at once, for fits that filter them and take products of their shifts again and
// again: side by side for the filters, one behind the other for the products.

namespace mpm {

/// `count` signals of `samples` numbers, eight of them side by side, with `memory` zeros before the first
/// one.
class SignalBank {
 public:
  using Signal = Eigen::Map<Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<8>>;
  using ConstSignal = Eigen::Map<const Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<8>>;

  SignalBank(Eigen::Index count, Eigen::Index samples, Eigen::Index memory);

  Eigen::Index count() const { return count_; }
  Eigen::Index samples() const { return samples_; }
  Eigen::Index memory() const { return memory_; }
  Signal operator[](Eigen::Index a) { return {at(a / 8, 0) + a % 8, samples_, Eigen::InnerStride<8>()}; }
  ConstSignal operator[](Eigen::Index a) const {
    return {at(a / 8, 0) + a % 8, samples_, Eigen::InnerStride<8>()};
  }
  /// Sample k, -memory() or later, of the eight signals of a group.
  double* at(Eigen::Index group, Eigen::Index k) { return memory_of_.data() + place(group, k); }
  const double* at(Eigen::Index group, Eigen::Index k) const { return memory_of_.data() + place(group, k); }

 private:
  Eigen::Index place(Eigen::Index group, Eigen::Index k) const {
    return 8 * (group * (memory_ + samples_) + memory_ + k);
  }

  Eigen::Index count_, samples_, memory_;
  LaneMemory memory_of_;
};

/// Each signal through its filter from rest, q^-delay B/F: `filter` of all of them at once, with the same
/// equation.
///
/// | symbol | meaning                                        | shape          |
/// |--------|------------------------------------------------|----------------|
/// | B      | numerators, a column a signal                  | nb x count     |
/// | F      | denominators, their first row is taken for 1   | nf + 1 x count |
///
/// `out` may be `in` only without a numerator of more than one coefficient and without a delay. The memory of
/// the banks must reach nb - 1 + delay and nf samples back.
void filter_bank(const Eigen::Ref<const Eigen::MatrixXd>& B, const Eigen::Ref<const Eigen::MatrixXd>& F,
                 Eigen::Index delay, const SignalBank& in, SignalBank& out);

/// Signals one behind the other, each with zeros before it, as far as `memory` says.
class ShiftedSignals {
 public:
  ShiftedSignals(Eigen::Index count, Eigen::Index samples, Eigen::Index memory);

  Eigen::Index samples() const { return values_.rows() - memory_; }
  auto operator[](Eigen::Index a) { return values_.col(a).tail(samples()); }
  auto operator[](Eigen::Index a) const { return values_.col(a).tail(samples()); }
  /// Sample 0; those before it are zeros.
  const double* data(Eigen::Index a) const { return values_.col(a).data() + memory_; }

 private:
  Eigen::Index memory_;
  Eigen::MatrixXd values_;
};

/// Columns of a regression: signal `signal` delayed by `lag`, `lag` + 1, ..., `count` of them.
struct LaggedColumns {
  Eigen::Index signal, lag, count;
};

Eigen::Index column_count(const std::vector<LaggedColumns>& columns);

/// The columns themselves, samples `first` and later.
Eigen::MatrixXd lagged_matrix(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                              Eigen::Index first);

/// X'X of these columns X. A product of two columns follows from that of the two columns before them by two
/// samples, so that only the products of the first columns are sums over the record.
Eigen::MatrixXd lagged_products(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                                Eigen::Index first);

/// X'x, x being signal `with`.
Eigen::VectorXd lagged_products_with(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                                     Eigen::Index with, Eigen::Index first);

}  // namespace mpm
