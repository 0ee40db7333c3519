#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/signal_bank.hpp"

namespace mpm {

/// `count` columns of a regression: signal `signal` delayed by `lag`, `lag` + 1, ...
struct LaggedColumns {
  Eigen::Index signal, lag, count;
};

Eigen::Index column_count(const std::vector<LaggedColumns>& columns);

/// Returns the columns themselves, from sample `first` on.
Eigen::MatrixXd lagged_matrix(const SignalBank& signals, const std::vector<LaggedColumns>& columns,
                              Eigen::Index first);

/// Which signals of a bank are multiplied with each other.
enum class LagPairs {
  all = 0,
  partners = 1,  ///< each with itself and with its partner in the other half of its group of eight
};

/// The sums of a(k) b(k - l) over the samples `first` and later, for signals a and b of a bank and a few lags
/// l. All products of shifted signals follow from them: the product of two columns differs from that of the
/// two columns before them by two samples. Only the first `delayed` signals are delayed, that is, have
/// columns. The memory of the bank and `first` must together reach `largest_lag` samples back, and one more
/// for LagPairs::partners.
class LagSums {
 public:
  void compute(const SignalBank& signals, Eigen::Index delayed, Eigen::Index largest_lag, Eigen::Index first,
               LagPairs pairs = LagPairs::all);

  /// X'X of these columns X.
  Eigen::MatrixXd products(const std::vector<LaggedColumns>& columns) const;
  /// X'x, x being signal `with`.
  Eigen::VectorXd products_with(const std::vector<LaggedColumns>& columns, Eigen::Index with) const;

 private:
  void add_all(const SignalBank& signals, Eigen::Index delayed, Eigen::Index first);
  void add_partners(const SignalBank& signals, Eigen::Index first);
  double sum(Eigen::Index a, Eigen::Index b, Eigen::Index lag) const;
  double sum_of_all(Eigen::Index a, Eigen::Index b, Eigen::Index lag) const;
  double sum_of_partners(Eigen::Index a, Eigen::Index b, Eigen::Index lag) const;
  /// The product of two columns of signals a and b.
  double product(Eigen::Index a, Eigen::Index lag_a, Eigen::Index b, Eigen::Index lag_b) const;
  void fill(const LaggedColumns& a, const LaggedColumns& b, Eigen::Ref<Eigen::MatrixXd> block) const;

  LagPairs pairs_ = LagPairs::all;
  Eigen::Index lags_ = 0, groups_ = 0;
  LaneMemory sums_;
  Eigen::MatrixXd before_, last_;  ///< of each signal, samples first - t and N - t in row t
};

}  // namespace mpm
