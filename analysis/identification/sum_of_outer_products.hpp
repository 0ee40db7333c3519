#pragma once

#include <Eigen/Core>

namespace mpm {

/// The sum over k of v(k) v(k)', for vectors v(k) of p elements that come one by one. They are kept until
/// there are enough of them for a product of matrices, which is several times as fast as products of vectors.
class SumOfOuterProducts {
 public:
  explicit SumOfOuterProducts(Eigen::Index size)
      : sum_(Eigen::MatrixXd::Zero(size, size)), kept_(size, kBlock) {}

  /// Where the next vector is to be written.
  auto next() {
    if (count_ == kBlock)
      fold();
    return kept_.col(count_++);
  }

  /// The sum so far, p x p; what lies above its diagonal is 0.
  const Eigen::MatrixXd& lower() {
    fold();
    return sum_;
  }

 private:
  static constexpr Eigen::Index kBlock = 64;  // 25 kB of 50 elements: within a first-level cache

  void fold() {
    if (count_ > 0)
      sum_.selfadjointView<Eigen::Lower>().rankUpdate(kept_.leftCols(count_));
    count_ = 0;
  }

  Eigen::MatrixXd sum_, kept_;
  Eigen::Index count_ = 0;
};

}  // namespace mpm
