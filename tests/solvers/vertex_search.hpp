#pragma once

#include <optional>
#include <vector>

#include "solvers/mpc_options.hpp"

namespace mpm::samples {

/// The target problem (6.19) for three MVs by brute force: its limits are planes in the space of targets, and
/// a linear (or piecewise linear, with bends on the planes) cost over a box has its minimum at a point where
/// three planes meet.
class VertexSearch {
 public:
  VertexSearch(const Eigen::MatrixXd& static_gain, const MpcOptions& options,
               const Eigen::VectorXd& y_at_zero);

  /// The cheapest vertex that keeps every soft limit; none when no vertex does.
  std::optional<Eigen::Vector3d> keeping_all_limits() const;

  /// Smallest possible sum of the violations of the soft limits.
  double smallest_violation() const;

  /// Smallest mv_cost' u + price * (sum of violations).
  double smallest_cost(double price) const;

  /// Sum of the violations of the soft limits by targets `u`.
  double violation(const Eigen::Vector3d& u) const;

 private:
  Eigen::MatrixXd gain_;
  Eigen::VectorXd cost_, low_, high_;
  std::vector<Eigen::Vector3d> vertices_;
};

}  // namespace mpm::samples
