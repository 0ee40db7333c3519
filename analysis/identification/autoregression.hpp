#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// An autoregression with a constant that is fitted by least squares to a signal,
///
///   e(k) = c + a_1 e(k-s) + ... + a_p e(k-ps) + w(k)
///
/// with the spacing s of its samples (sample_spacing()), which is 1 except for a CV of an analyser.
///
/// | symbol | member     | shape            | meaning                                                   |
/// |--------|------------|------------------|-----------------------------------------------------------|
/// | c, a   | theta      | p + 1            | constant, then the coefficients                           |
/// |        | covariance | (p + 1)^2        | of theta: sigma^2 (Phi'Phi)^-1                            |
/// | k      | rows       | n                | samples fitted: those known together with the p before    |
struct Autoregression {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  std::vector<Eigen::Index> rows;
  Eigen::Index spacing = 1;

  Eigen::Index order() const { return theta.size() - 1; }
  /// n - p - 1
  Eigen::Index freedom() const { return static_cast<Eigen::Index>(rows.size()) - theta.size(); }
  /// x(k) - a_1 x(k-s) - ... - a_p x(k-ps) of each column of x (N x m) at the rows, n x m: a signal as this
  /// filter leaves it, which makes the fitted one white.
  Eigen::MatrixXd whitened(const Eigen::Ref<const Eigen::MatrixXd>& x) const;
};

/// The samples that are not NaN, nor is any of the `order` samples before, at the spacing of the signal.
std::vector<Eigen::Index> known_rows(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index order);

/// The order 0 ... `largest_order` of least BIC, n ln V + p ln n, all fitted to the same samples. 0 for a
/// record with fewer than three such samples for each coefficient, and for a signal that stands still.
/// @throws InputError for a largest order below 0
Eigen::Index autoregression_order(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index largest_order);

/// The autoregression of this order; missing samples (NaN) are left out with those that follow them.
/// @throws InputError for an order below 0, or no more samples than coefficients
Autoregression fit_autoregression(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index order);

/// ln p of the test that two signals, which are independent of each other, have the same constant and the
/// same coefficients, and any two variances:
///
///   F = (theta_1 - theta_2)' (V_1 + V_2)^-1 (theta_1 - theta_2) / (p + 1)
///
/// against F(p + 1, the fewer degrees of freedom of the two), as Wald has it. Of two signals that differ
/// by a factor alone the constants differ and the colours do not. 0 when V_1 + V_2 has no inverse.
/// @throws InputError for two orders
double log_p_same_autoregression(const Autoregression& one, const Autoregression& other);

}  // namespace mpm
