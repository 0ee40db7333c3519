#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/disturbance_scan.hpp"

namespace mpm {

/// The simulation errors of one CV, whitened once under the noise of its model. Hypotheses that say what was
/// added to the CV, h (N, in standard deviations of the noise), are compared by what they leave,
///
///   e - h = Z' z + n,   z ~ N(0, I).
class WhitenedErrors {
 public:
  /// `series` (1 + q x N): e, NaN where there is no sample, and below it Z, in standard deviations of the
  /// noise (CvLikelihood::healthy_series()).
  WhitenedErrors(const BaseNoise& noise, const Eigen::MatrixXd& series, double noise_freedom);

  Eigen::Index size() const { return e_.size(); }
  /// How many samples of the CV there are.
  double samples() const { return likelihood_.samples; }

  /// log L of the errors less h.
  double log_likelihood(const Eigen::Ref<const Eigen::RowVectorXd>& h) const;

  /// SSE(a) = SSE(0) - 2 a product + a^2 squares, of the errors less a h.
  struct Amplitude {
    double product, squares;
  };
  Amplitude amplitude(const Eigen::Ref<const Eigen::RowVectorXd>& h) const;

  /// By how much each row of `h` lowers the square of each whitened sample, without Z; of the shape of `h`.
  Eigen::MatrixXd gains(const Eigen::Ref<const Eigen::MatrixXd>& h) const;

 private:
  Eigen::MatrixXd white_of(const Eigen::Ref<const Eigen::MatrixXd>& h) const;
  /// a' b of two whitened rows, without what Z explains of them.
  double product_of(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) const;

  NoiseModels models_;
  Eigen::RowVectorXd e_, white_;
  ScaleLikelihood likelihood_;
  double log_determinant_ = 0.0;
  Eigen::MatrixXd Z_;
  Eigen::LLT<Eigen::MatrixXd> inner_;
};

}  // namespace mpm
