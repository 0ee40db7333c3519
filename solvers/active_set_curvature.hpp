#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_problem.hpp"
#include "solvers/active_set_springs.hpp"

namespace mpm {

/// The generalised Hessian of the penalised problem,
///
///     M = Q + diag(sigma) + sum over stretched springs of k_i b_i b_i',    b_i = (a_i, e at the slack of i),
///
/// kept from one iteration and one sample to the next: only springs that were stretched or released since
/// are added or taken off. It is built anew when that is the smaller work.
class ActiveSetCurvature {
 public:
  ActiveSetCurvature(const ActiveSetProblem& problem, std::size_t family_count);

  /// Forgets the springs: M = Q + diag(sigma).
  void clear();
  /// Brings M up to the springs' present forces; false when that changed nothing.
  bool synchronise(const std::vector<LimitSprings>& families);

  /// M in its lower triangle.
  const Eigen::MatrixXd& matrix() const { return matrix_; }

 private:
  struct Term {
    const double* row;
    double weight;
  };

  struct Change {
    std::size_t family;
    Eigen::Index row;
  };

  void find_changes(const std::vector<LimitSprings>& families);
  void add(const LimitSprings& springs, Eigen::Index i, double weight);
  void flush();

  const ActiveSetProblem& problem_;
  Eigen::MatrixXd matrix_;
  std::vector<std::vector<unsigned char>> included_;  ///< one flag a family and row
  std::vector<bool> touched_;                         ///< families with springs in M, at any time
  std::vector<Change> changes_;                       ///< springs that M does not have as they are
  std::size_t stretched_ = 0;
  std::vector<Term> pending_;  ///< terms that wait to be added together
};

}  // namespace mpm
