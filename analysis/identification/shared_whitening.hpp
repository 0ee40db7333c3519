#pragma once

#include <vector>

#include <Eigen/Core>

#include "plants/linear/zero_order_hold.hpp"

namespace mpm {

/// One of several series that the same disturbance x moves, each through a channel of its own,
///
///   z_i(k) = H_i x(k) + n_i(k) + white_i v_i(k),   n_i(k+1) = a_i n_i(k) + b_i w_i(k),
///   x(k+1) = a x(k) + b w(k),
///
/// all of w and v independent, white, normal, variance 1, x and n stationary. The past of an integrating
/// channel counts as about a thousand samples long.
struct SharedOutput {
  DiscreteChannel channel;        ///< H, in units of z per unit of x
  double a = 0.0, b = 0.0;        ///< of the slow noise of the series; b = 0: it has none
  double white = 1.0;             ///< standard deviation of the white noise
  const Eigen::MatrixXd* series;  ///< p_i x N: z (NaN: no sample), then the rows to be whitened with it

  bool has_slow_noise() const { return b != 0.0; }
  Eigen::Index states() const { return channel.A.rows() + (has_slow_noise() ? 1 : 0); }
};

/// Products of the whitened series. The first rows of all series count as one row, the rows below them as one
/// each: p = 1 + sum (p_i - 1) in all.
struct SharedProducts {
  Eigen::VectorXd log_determinant;  ///< of the innovations of each series
  /// Products of the whitened rows over the innovations of each series, p x p, the lower triangles.
  std::vector<Eigen::MatrixXd> products;
};

/// Whitens series with a shared disturbance by a Kalman filter. The series are shifted against each other by
/// the dead times of their channels, so that dead times need no states: a normal density does not depend on
/// the order in which its samples are read. The rows below the first one of a series belong to this series
/// alone.
class SharedWhitening {
 public:
  /// The series must outlive this. Throws nothing; at least one series.
  explicit SharedWhitening(std::vector<SharedOutput> outputs);

  /// Returns the products for an x with these a and b. With `rows` they include the rows below the first
  /// ones; otherwise p = 1.
  SharedProducts products(double a, double b, bool rows) const;

 private:
  class Filter;

  std::vector<SharedOutput> outputs_;
  Eigen::Index states_, rows_, longest_delay_;
};

}  // namespace mpm
