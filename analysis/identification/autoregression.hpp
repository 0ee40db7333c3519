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
/// | k      | rows       | n                | samples fitted: known, and so are the p samples before    |
struct Autoregression {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  std::vector<Eigen::Index> rows;
  Eigen::Index spacing = 1;

  Eigen::Index order() const { return theta.size() - 1; }
  /// n - p - 1
  Eigen::Index freedom() const { return static_cast<Eigen::Index>(rows.size()) - theta.size(); }
  /// x(k) - a_1 x(k-s) - ... - a_p x(k-ps) of each column of x (N x m) at the rows, n x m: the output of the
  /// filter that makes the fitted signal white.
  Eigen::MatrixXd whitened(const Eigen::Ref<const Eigen::MatrixXd>& x) const;
};

/// Returns the samples that are not NaN and have `order` samples before them that are not NaN either, at the
/// spacing of the signal.
std::vector<Eigen::Index> known_rows(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index order);

/// Returns the order 0 ... `largest_order` with the least BIC, n ln V + p ln n. All orders are fitted to the
/// same samples. 0 if there are fewer than three such samples for each coefficient, or if the signal stands
/// still.
/// @throws InputError for a largest order below 0
Eigen::Index autoregression_order(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index largest_order);

/// Fits the autoregression of this order. Leaves out missing samples (NaN) and the samples that would need
/// them as their past.
/// @throws InputError for an order below 0, or no more samples than coefficients
Autoregression fit_autoregression(const Eigen::Ref<const Eigen::VectorXd>& e, Eigen::Index order);

/// Returns ln p of the test that two independent signals have the same constant and the same coefficients,
/// whatever their variances:
///
///   F = (theta_1 - theta_2)' (V_1 + V_2)^-1 (theta_1 - theta_2) / (p + 1)
///
/// compared with F(p + 1, the smaller of the two degrees of freedom), after Wald. If two signals differ by a
/// factor alone, their constants differ and their coefficients a do not. 0 if V_1 + V_2 has no inverse.
/// @throws InputError for different orders
double log_p_same_autoregression(const Autoregression& one, const Autoregression& other);

}  // namespace mpm
