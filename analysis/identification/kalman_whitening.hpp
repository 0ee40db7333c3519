#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Models of the noise of a scalar series, several at once,
///
///   z(k) = x(k) + n(k),   x(k+1) = a x(k) + b w(k),   n(k) = phi n(k-1) + sqrt(1 - phi^2) v(k),
///
/// w and v independent, white, normal, variance 1: a slow disturbance under measurement noise of the variance
/// 1. b = 0 leaves the measurement noise.
struct NoiseModels {
  Eigen::ArrayXd a, b;           ///< one element a model, |a| < 1
  double phi = 0.0;              ///< the same for all
  bool starts_from_rest = true;  ///< x(0) = 0; otherwise x is stationary

  Eigen::Index count() const { return a.size(); }
};

/// What the likelihood of normal series needs of them: with L the lower triangular factor of the covariance
/// of the noise over the observed samples, log |L|^2 and the products (L^-1 s_i)' (L^-1 s_j).
struct WhitenedProducts {
  Eigen::ArrayXd log_determinant;  ///< one a model
  /// products[i (i + 1) / 2 + j], j <= i: of the series i and j, one a model.
  std::vector<Eigen::ArrayXd> products;

  const Eigen::ArrayXd& of(Eigen::Index i, Eigen::Index j) const;
};

/// By a Kalman filter with one state, whose gains are those of all series. `series` (p x N) has one series a
/// row; a sample at which the first one is NaN is not observed in any. With phi != 0 the filter forgets what
/// n was before a gap.
WhitenedProducts whitened_products(const NoiseModels& models,
                                   const Eigen::Ref<const Eigen::MatrixXd>& series);

/// Of the first `rows` series when the others, Z (q x N), are added to the noise with coefficients of their
/// own, z ~ N(0, I): the noise has the covariance L L' + Z' Z.
WhitenedProducts marginalised(const WhitenedProducts& sums, Eigen::Index rows, Eigen::Index q);

/// L^-1 of each row of `series` under the first of the models, p x N, and 0 where nothing is observed; log
/// |L|^2 in `log_determinant`.
Eigen::MatrixXd whitened(const NoiseModels& models, const Eigen::Ref<const Eigen::MatrixXd>& series,
                         double& log_determinant);

}  // namespace mpm
