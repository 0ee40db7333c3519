#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_correction.hpp"
#include "solvers/active_set_curvature.hpp"
#include "solvers/active_set_factor.hpp"
#include "solvers/active_set_problem.hpp"
#include "solvers/active_set_springs.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

enum class NewtonOutcome { converged, iteration_limit, singular };

/// Minimises the penalised problem over the box: the convex, piecewise quadratic
///
///     theta(z) = 1/2 z'Qz + c'z + 1/2 sum_j sigma_j (z_j - centre_j)^2 + penalties of the springs,
///     lower <= z <= upper,
///
/// by Newton's method on the free variables with an exact line search (docs/active_set.md).
/// All memory is taken at construction; z, the factor and the curvature are kept from call to call.
class ActiveSetNewton {
 public:
  ActiveSetNewton(const ActiveSetProblem& problem, std::size_t family_count);

  /// Sets z = 0, as after construction.
  void reset();

  /// To be called after the stiffness of springs was changed.
  void forget_curvature();

  /// Finds a starting point in the box from the active sets of the last call, and the springs' values there.
  void start(std::vector<LimitSprings>& families);

  /// Minimises until the projected gradient is at most `tolerance`. Counts `iterations` up, to `limit` at
  /// most. The springs' forces are those at z afterwards.
  NewtonOutcome minimise(std::vector<LimitSprings>& families, double tolerance, int limit, int& iterations);

  /// The largest |sigma_j (z_j - centre_j)|: what the proximal term still adds to the gradient.
  double proximal_force() const;

  LaneVector z, centre;
  LaneVector linear, lower, upper;  ///< c and the box, set by the caller before `start`
  LaneVector gradient;              ///< of theta at z, after `minimise`
  LaneVector row_value;             ///< A x

  /// True if variable j rests on a limit against which its gradient pushes it.
  bool held(Eigen::Index j) const;

 private:
  void predict(std::vector<LimitSprings>& families);
  void follow_limits();
  void find_gradient(const std::vector<LimitSprings>& families);
  void add_row_forces(const LimitSprings& springs);
  double find_free();
  bool find_direction(const std::vector<LimitSprings>& families, bool anew);
  bool correct_factor(const std::vector<LimitSprings>& families);
  bool make_factor(const std::vector<LimitSprings>& families);
  void solve_for_direction();
  bool aim_projected();
  void aim_truncated(const std::vector<LimitSprings>& families);
  void freeze_blocked(const std::vector<LimitSprings>& families);
  double steady_curvature(std::vector<LimitSprings>& families, double slope);
  double whole_curvature(std::vector<LimitSprings>& families);
  void aim_springs(std::vector<LimitSprings>& families);
  double line_search(std::vector<LimitSprings>& families, double slope);

  const ActiveSetProblem& problem_;
  ActiveSetCurvature curvature_;
  ActiveSetFactor factor_;
  ActiveSetCorrection correction_;
  std::vector<SpringChange> changes_;  ///< what `correction_` was asked for
  bool factored_ = false;
  bool newton_step_ = false;  ///< `step_` is the whole step of Newton's method: nothing of it was cut off
  std::vector<int> free_, next_free_;
  LaneVector direction_, step_, target_, row_step_, scratch_;
};

}  // namespace mpm
