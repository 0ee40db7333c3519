#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_correction.hpp"
#include "solvers/active_set_problem.hpp"
#include "solvers/active_set_springs.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// The generalised Hessian of the penalised problem,
///
///     M = Q + diag(sigma) + sum over stretched springs of k_i b_i b_i',    b_i = (a_i, e at the slack of i),
///
/// kept from one iteration and one sample to the next: only springs that were stretched or released since
/// then are added or taken out. M is built anew if that is less work.
class ActiveSetCurvature {
 public:
  ActiveSetCurvature(const ActiveSetProblem& problem, std::size_t family_count);

  /// Forgets the springs: M = Q + diag(sigma).
  void clear();
  /// Updates M to the present forces of the springs. Returns false if nothing has changed.
  bool synchronise(const std::vector<LimitSprings>& families);
  /// Finds the changes that synchronise() would make. Returns false if they are more than
  /// ActiveSetCorrection::kMost springs.
  bool find_few(const std::vector<LimitSprings>& families, std::vector<SpringChange>& changes) const;

  /// M in its lower triangle, followed by columns of the unit matrix up to the stride. The numbers above the
  /// diagonal are arbitrary.
  const LaneMatrix& matrix() const { return matrix_; }

 private:
  std::size_t find_changes(const std::vector<LimitSprings>& families);
  void add(const LimitSprings& springs, std::size_t family);

  const ActiveSetProblem& problem_;
  LaneMatrix matrix_;
  std::vector<RowBits> included_;          ///< of each family: springs that M has
  std::vector<std::vector<int>> changes_;  ///< of each family: springs that M has wrongly or lacks
  std::vector<double> weights_;
  LaneVector scratch_;
  std::size_t stretched_ = 0;
};

}  // namespace mpm
