#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Models of the noise of a scalar series, several at once,
///
///   z(k) = x(k) + n(k),   x(k+1) = a x(k) + b w(k),   n(k) = phi n(k-1) + sqrt(1 - phi^2) v(k),
///
/// w and v independent, white, normal, variance 1: a slow disturbance x and measurement noise n of
/// variance 1. With b = 0 only the measurement noise is left.
struct NoiseModels {
  Eigen::ArrayXd a, b;           ///< one element per model, |a| < 1
  double phi = 0.0;              ///< the same for all models
  bool starts_from_rest = true;  ///< x(0) = 0; otherwise x is stationary

  Eigen::Index count() const { return a.size(); }
};

/// The numbers from which the likelihood of normal series follows: log |L|^2 and the products (L^-1 s_i)'
/// (L^-1 s_j), with L the lower triangular factor of the covariance of the noise over the observed samples.
struct WhitenedProducts {
  Eigen::ArrayXd log_determinant;  ///< one per model
  /// products[i (i + 1) / 2 + j], j <= i: of the series i and j, one per model.
  std::vector<Eigen::ArrayXd> products;

  const Eigen::ArrayXd& of(Eigen::Index i, Eigen::Index j) const;
};

/// Computes the products by a Kalman filter with one state. Its gains are the same for all series. `series`
/// (p x N) has one series per row. If the first series is NaN at a sample, none is observed there. With
/// phi != 0 the filter forgets the value that n had before a gap.
WhitenedProducts whitened_products(const NoiseModels& models,
                                   const Eigen::Ref<const Eigen::MatrixXd>& series);

/// Returns the products of the first `rows` series if the other series, Z (q x N), are part of the noise with
/// random coefficients z ~ N(0, I): the noise then has the covariance L L' + Z' Z.
WhitenedProducts marginalised(const WhitenedProducts& sums, Eigen::Index rows, Eigen::Index q);

/// Returns L^-1 s for each row s of `series` under the first of the models, p x N, with 0 where nothing is
/// observed. Writes log |L|^2 to `log_determinant`.
Eigen::MatrixXd whitened(const NoiseModels& models, const Eigen::Ref<const Eigen::MatrixXd>& series,
                         double& log_determinant);

}  // namespace mpm
