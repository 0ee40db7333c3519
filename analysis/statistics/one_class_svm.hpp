#pragma once

#include <Eigen/Core>

namespace mpm {

/// A one-class support vector machine with a radial kernel, trained by libsvm (Schoelkopf, Platt,
/// Shawe-Taylor, Smola and Williamson 2001): a point x lies outside of the learnt region if
///
///   sum_i alpha_i exp(-gamma |x - x_i|^2) < rho,   0 <= alpha_i <= 1,   sum_i alpha_i = nu n
///
/// | symbol  | name     | shape | meaning                                        |
/// |---------|----------|-------|------------------------------------------------|
/// | x_i     | points   | m x n | training points, one in each column            |
/// | nu      | nu       |       | largest share of these points that lie outside |
/// | gamma   | gamma    |       | width parameter of the kernel                  |
class OneClassSvm {
 public:
  /// @throws InputError for no points, values that are not finite, nu outside (0, 1) or gamma not above 0
  OneClassSvm(const Eigen::Ref<const Eigen::MatrixXd>& points, double nu, double gamma);

  /// Returns ln rho - ln sum_i alpha_i K(x, x_i), which is above 0 where the decision function is negative.
  /// Far away from the points it grows as gamma times the square of the distance, whereas the decision
  /// function itself is -rho for every x.
  /// @throws InputError if x does not have m elements
  double outsideness(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  Eigen::MatrixXd support_;     ///< the x_i with alpha_i > 0
  Eigen::ArrayXd log_weights_;  ///< ln alpha_i
  double log_rho_ = 0.0;
  double gamma_;
};

}  // namespace mpm
