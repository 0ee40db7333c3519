#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/lag_sums.hpp"
#include "analysis/identification/signal_bank.hpp"

namespace mpm {

/// The coefficients of an output-error model y = sum_j q^-delay B_j/F_j u_j + e whose paths have equal
/// orders.
struct OutputErrorCoefficients {
  Eigen::MatrixXd B;  ///< nb x nu
  Eigen::MatrixXd F;  ///< nf + 1 x nu; the first row is 1

  /// The number of rows that polynomials need to hold F and q^-delay B.
  Eigen::Index rows(Eigen::Index delay) const { return std::max(F.rows(), B.rows() + delay); }
};

/// Whether all roots of every F lie within `radius`.
bool roots_within(const Eigen::MatrixXd& F, double radius);

/// The errors e of output-error models of one output, and their gradient J with respect to the coefficients
/// b_0 ..., f_1 ... of each input in turn:
///
///   de/db_i = -q^-(i + delay) u/F,   de/df_i = q^-i B u/F^2
///
/// | symbol | meaning | shape  |
/// |--------|---------|--------|
/// | u      | inputs  | nu x N |
/// | y      | output  | N      |
class OutputErrors {
 public:
  /// For models whose polynomials need up to `rows` rows.
  OutputErrors(const Eigen::Ref<const Eigen::MatrixXd>& u, const Eigen::Ref<const Eigen::VectorXd>& y,
               Eigen::Index delay, Eigen::Index rows);

  /// Half the sum of e^2 of this model, whose roots must be inside the unit circle; infinity if the sum is
  /// not finite.
  double cost(const OutputErrorCoefficients& model);
  /// J'J and J'e at the model of the last call of `cost`. All columns of J are shifts of two signals per
  /// input.
  void products(Eigen::MatrixXd& JJ, Eigen::VectorXd& Je);

 private:
  Eigen::Index nu_, delay_;
  std::vector<LaggedColumns> columns_;
  SignalBank twice_;     ///< the inputs, and a second copy of them
  SignalBank path_;      ///< the response to the second copy, B u/F
  SignalBank gradient_;  ///< -u/F, B u/F^2 and e
  LagSums sums_;
  Eigen::VectorXd y_, errors_;
};

}  // namespace mpm
