#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_problem.hpp"
#include "solvers/lanes/lane_kernels.hpp"
#include "solvers/lanes/lane_vector.hpp"
#include "solvers/lanes/row_bits.hpp"

namespace mpm {

/// One family of row limits as springs: row i with value v_i = a_i x + e s_q(i) feels the force
///
///     F_i = k_i (v_i - clamp(v_i, lower_i, upper_i)),    stretched: F_i != 0,
///
/// the derivative of the convex penalty k_i/2 dist(v_i, [lower_i, upper_i])^2. A soft limit with an
/// eliminated slack has k_i = 2w. A limit that must hold exactly is a spring with a multiplier: its lower and
/// upper are the limits less multiplier_i / k_i, and F_i becomes its multiplier (method of multipliers).
///
/// | symbol | member     | meaning                                                        |
/// |--------|------------|----------------------------------------------------------------|
/// | e      | slack_sign | 0; -1: upper limit with a kept slack; +1: lower limit with one |
/// | k      | stiffness  | 0: no spring                                                   |
struct LimitSprings {
  LimitSprings(double slack_sign, const Eigen::VectorXd& stiffness);

  Eigen::Index size() const { return stiffness.size(); }
  bool stretched(Eigen::Index i) const { return force(i) != 0.0; }

  /// Sets the limits of the family from those of the rows, shifted by the multipliers.
  void set_limits(const Eigen::VectorXd& row_lower, const Eigen::VectorXd& row_upper);

  /// Sets the values v from the row values A x and z. Without slacks v refers to the row values, which must
  /// stay at their place and follow every step before `advance`.
  void place(const ActiveSetProblem& problem, const LaneVector& row_value, const LaneVector& z);
  /// Sets the step, the change of v along a direction; `row_step` as row_value in `place`.
  void aim(const ActiveSetProblem& problem, const LaneVector& row_step, const LaneVector& p);

  /// Sets `force` from v.
  void pull();
  /// Sets the force of the stretched springs, at the ends where they are, as if they could also push; zero
  /// where the limit no longer exists.
  void pull_stretched();
  /// Sets the force to zero, wherever the springs are.
  void release();
  /// The stretched springs, in increasing order.
  const std::vector<int>& stretched_rows() const { return stretched_rows_; }
  const RowBits& stretched_bits() const { return stretched_bits_; }

  /// Finds the springs that a whole step would stretch, release or take to their other end. Returns false if
  /// there is none: then the penalty is one quadratic all along the step.
  bool find_changing();
  /// Second derivative of the penalty at the start of the step: of all springs, and of those that change. The
  /// others keep theirs all along the step: a spring that is stretched (or not) at both ends is so in
  /// between.
  double curvature();
  double changing_curvature() const;
  /// Adds, for the changing springs, the derivative of the penalty along the step at t less that at 0, and
  /// the second derivative at t.
  void add_changing(double t, double& first, double& second) const;

  /// Moves by t along the step. `same`: no spring changes and t = 1; the force is then advanced by k times
  /// the step, which is more accurate than the difference of position and limit.
  void advance(double t, bool same);

  double slack_sign;
  bool enabled = true;  ///< false: the family is left out, and its force is zero
  LaneVector stiffness, lower, upper, multiplier;
  LaneVector force;

 private:
  /// Numbers of the springs: those of the rows or, if there are slacks, copies in `own` with the slacks'
  /// share.
  struct Numbers {
    const double* data = nullptr;
    LaneVector own;
  };

  void assign(Numbers& to, const ActiveSetProblem& problem, const LaneVector& rows,
              const LaneVector& z) const;
  SpringArrays arrays();
  void list_stretched();

  Numbers value_, step_;
  bool everywhere_;                ///< every row has a spring
  RowBits stretched_bits_, none_;  ///< the rows where `force` is not 0; no row
  std::vector<int> stretched_rows_;
  std::vector<int> changing_;  ///< has room for all rows; the first `changing_count_` are valid
  std::size_t changing_count_ = 0;
};

}  // namespace mpm
