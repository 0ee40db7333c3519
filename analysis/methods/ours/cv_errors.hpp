#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"

// The simulation errors of one CV under noise that nobody knows.

namespace mpm {

using Columns = Eigen::MatrixXd;

/// Order of the autoregression of the noise: it approximates a disturbance behind two lags, beside white
/// noise.
inline constexpr Eigen::Index kErrorOrder = 6;

/// Consecutive samples of a record.
struct Part {
  Eigen::Index first, count;
};

/// sum_k A(k - l)' B(k - m), 0 <= l, m <= kErrorOrder, for signals A (n x p) and B (n x q), over those
/// samples k of a part that have a past of this length. From these the products of signals that an
/// autoregression a whitens follow without the signals. Only the sum of (l, m) and (m, l) is kept, since both
/// count alike.
class LaggedProducts {
 public:
  LaggedProducts(const Columns& A, const Columns& B, Part part);

  LaggedProducts& operator+=(const LaggedProducts& more);

  /// (A_0 - sum_l a_l A_l)' (B_0 - sum_m a_m B_m), p x q, A_l being l samples late
  Columns whitened_by(const Eigen::VectorXd& a) const;

  /// The same products of the signals A x and B y, one value for each l <= m; those of l < m count twice.
  Eigen::VectorXd of(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const;

 private:
  Eigen::Index rows_, columns_;
  Eigen::MatrixXd pairs_;  ///< rows x columns of a pair of lags in each column
};

/// The errors e of CV i over the n samples that are there, and how likely they are under a hypothesis h:
///
///   e = h + X a + E_i b + n,   a ~ N(0, I),   b of any size
///   L = -n/2 log s^2 - |a|^2 / 2
///
/// with X the responses to errors of a healthy model, E_i the errors of the other CVs in up to six samples
/// before (those above i also in the same sample), which show a disturbance that reaches several CVs, n an
/// autoregression of the order kErrorOrder, which stands for a disturbance of any shape, and s^2 the mean
/// square of its innovations. From some sample on n may be a different autoregression and b may have other
/// values. The best a, b and noise follow from LaggedProducts, so that a further hypothesis costs only the
/// products of its h.
class CvErrors {
 public:
  /// `samples` of the loop, e (n) at them, and X (n x p, or empty). The errors of the other CVs are those of
  /// the loop.
  CvErrors(const AssessedLoop& loop, Eigen::Index cv, std::vector<Eigen::Index> samples,
           const Eigen::VectorXd& e, const Columns& X);

  /// Lets the noise change from the best of some samples on, if that explains the errors better.
  void find_change();

  double none() const { return none_; }
  /// The sample of the loop at which the noise changes; 0: it is the same throughout.
  Eigen::Index change() const {
    return parts_.size() < 2 ? 0 : samples_[static_cast<std::size_t>(parts_.back().part.first)];
  }
  double log_samples() const { return std::log(static_cast<double>(samples_.size())); }

  /// L with h (N of the loop) subtracted from the errors.
  double without(const Eigen::RowVectorXd& h) const { return without(h, Columns(h.size(), 0)); }
  /// The same, with these columns (N of the loop, each of any size) in the errors as well.
  double without(const Eigen::RowVectorXd& h, const Columns& free) const {
    return fit(parts_, told_columns(free, &h), free.cols()).log_likelihood;
  }
  double with(const Columns& free) const {
    return fit(parts_, told_columns(free, nullptr), free.cols()).log_likelihood;
  }
  /// The most likely size of a signal (N of the loop) in the errors.
  double size_of(const Eigen::RowVectorXd& h) const {
    return -fit(parts_, told_columns(h.transpose(), nullptr), 1).of_hypothesis(0);
  }

  /// input_dependence() since the noise changed, if h and `free` are in the errors. `moves` are those of the
  /// inputs (N of the loop).
  double dependence(const AssessedLoop& loop, const Eigen::RowVectorXd& h, const Columns& free,
                    const Columns& moves) const;

 private:
  /// A part, the products of [X E_i e] with itself over it, and its noise.
  struct NoisePart {
    Part part;
    LaggedProducts known;
    Eigen::VectorXd a;  ///< of the noise without a hypothesis; the fit of each hypothesis starts from it
  };

  /// The likelihood, and the coefficients of [X E_i e] and of the hypothesis with which their sum is what is
  /// left in the last part.
  struct Fit {
    double log_likelihood = 0.0;  ///< 0 for a CV that has too few samples to tell anything
    Eigen::VectorXd of_known, of_hypothesis;
    std::vector<Eigen::VectorXd> noises = {};  ///< a of each part
  };

  /// Fits a hypothesis [F h] (n x q + 1, or F alone), with F of any size.
  Fit fit(const std::vector<NoisePart>& parts, const Columns& hypothesis, Eigen::Index free) const;

  /// L without a hypothesis. Fits the noise of the parts to it.
  double settled(std::vector<NoisePart>& parts) const;

  /// [F h] at the samples, less what no record can tell; null: F alone.
  Columns told_columns(const Columns& free, const Eigen::RowVectorXd* h) const;

  /// Signals (n x m) less what no record can tell.
  Columns told(Columns signals) const;

  bool is_too_short() const { return Xe_.rows() <= kErrorOrder; }

  std::vector<Eigen::Index> samples_;
  Columns Xe_, Q_;           ///< [X E_i e], and an orthonormal basis of what no record can tell
  Eigen::Index errors_ = 0;  ///< columns of X
  std::vector<NoisePart> parts_;
  double none_ = 0.0;
};

}  // namespace mpm
