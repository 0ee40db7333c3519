#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"

// The simulation errors of one CV, and a noise that nobody knows.

namespace mpm {

using Columns = Eigen::MatrixXd;

/// Order of the autoregression of the noise: approximates a disturbance behind two lags beside white noise.
inline constexpr Eigen::Index kErrorOrder = 6;

/// A_l' B_m of signals (n x .) that are l and m samples late, l, m <= kErrorOrder, over the samples that have
/// a past of this length. The products of signals that an autoregression whitens follow from them without the
/// signals:
///
///   (A_0 - sum_l a_l A_l)' (B_0 - sum_m a_m B_m)
class LaggedProducts {
 public:
  LaggedProducts(const Columns& A, const Columns& B) {
    const Eigen::Index n = A.rows(), count = n - kErrorOrder;
    const auto late = [count](const Columns& signals, Eigen::Index lag) {
      return signals.middleRows(kErrorOrder - lag, count);
    };
    for (Eigen::Index m = 0; m < kLags; ++m)
      at(0, m) = late(A, 0).transpose() * late(B, m);
    for (Eigen::Index l = 1; l < kLags; ++l)
      at(l, 0) = &A == &B ? Columns(at(0, l).transpose()) : Columns(late(A, l).transpose() * late(B, 0));
    // One sample later a sample enters at the start, and one leaves at the end.
    for (Eigen::Index l = 0; l + 1 < kLags; ++l)
      for (Eigen::Index m = 0; m + 1 < kLags; ++m)
        at(l + 1, m + 1) = at(l, m) + A.row(kErrorOrder - 1 - l).transpose() * B.row(kErrorOrder - 1 - m) -
                           A.row(n - 1 - l).transpose() * B.row(n - 1 - m);
  }

  Columns whitened_by(const Eigen::VectorXd& a) const {
    Eigen::VectorXd factors(kLags);
    factors << 1.0, -a;
    Columns sum = Columns::Zero(products_.front().rows(), products_.front().cols());
    for (Eigen::Index l = 0; l < kLags; ++l)
      for (Eigen::Index m = 0; m < kLags; ++m)
        if (const double factor = factors(l) * factors(m); factor != 0.0)
          sum += factor * at(l, m);
    return sum;
  }

 private:
  static constexpr Eigen::Index kLags = kErrorOrder + 1;

  Columns& at(Eigen::Index l, Eigen::Index m) { return products_[static_cast<std::size_t>(l * kLags + m)]; }
  const Columns& at(Eigen::Index l, Eigen::Index m) const {
    return products_[static_cast<std::size_t>(l * kLags + m)];
  }

  std::array<Columns, static_cast<std::size_t>(kLags* kLags)> products_;
};

/// The errors e of CV i over the n samples that are there, and how likely they are under a hypothesis h:
///
///   e = h + X a + E_i b + n,   a ~ N(0, I),   b of any size
///   L = -n/2 log s^2 - |a|^2 / 2
///
/// with X the responses to errors of a healthy model, E_i the errors of the other CVs in up to six samples
/// before (those above i also in the same sample), which have a disturbance that reaches several CVs, n an
/// autoregression of the order kErrorOrder, which has one of any shape, and s^2 the mean square of its
/// innovations. From some sample on n may be another autoregression.
class CvErrors {
 public:
  /// `samples` of the loop, e (n) at them, and X (n x p, or empty). The errors of the other CVs are those of
  /// the loop.
  CvErrors(const AssessedLoop& loop, Eigen::Index cv, std::vector<Eigen::Index> samples,
           const Eigen::VectorXd& e, const Columns& X);

  /// Lets the noise be another one from the best of some samples on, or from `onset` on, where that explains
  /// the errors better.
  void find_change(Eigen::Index onset);

  double none() const { return none_; }
  double log_samples() const { return std::log(static_cast<double>(e_.size())); }

  /// With h (N of the loop) taken off.
  double without(const Eigen::RowVectorXd& h) const { return without(h, Columns(h.size(), 0)); }
  /// The same with these columns (N of the loop, each of any size) in it.
  double without(const Eigen::RowVectorXd& h, const Columns& free) const {
    return log_likelihood(e_ - told(h(samples_).transpose()), told_columns(free));
  }
  double with(const Columns& free) const { return log_likelihood(e_, told_columns(free)); }

  /// input_dependence() since the noise changed, where h and `free` are in the errors; `moves` of the inputs
  /// (N of the loop).
  double dependence(const AssessedLoop& loop, const Eigen::RowVectorXd& h, const Columns& free,
                    const Columns& moves) const;

 private:
  /// Samples that follow each other.
  struct Part {
    Eigen::Index first, count;

    Columns of(const Columns& signals) const { return signals.middleRows(first, count); }
  };

  /// The noise changes after this many samples.
  void divide(Eigen::Index change);

  Eigen::VectorXd told(const Eigen::VectorXd& signal) const {
    return Q_.size() == 0 ? signal : Eigen::VectorXd(signal - Q_ * (Q_.transpose() * signal));
  }

  Columns told_columns(const Columns& free) const;

  /// 0 of a CV that has too few samples to tell anything.
  double log_likelihood(const Eigen::VectorXd& e, const Columns& free, Eigen::VectorXd* left = nullptr) const;

  std::vector<Eigen::Index> samples_;
  Columns X_, Q_;
  Eigen::VectorXd prior_;  ///< precision of the coefficients of X
  std::vector<Part> parts_;
  std::vector<LaggedProducts> XX_;  ///< of each part
  Eigen::VectorXd e_;
  double none_ = 0.0;
};

}  // namespace mpm
