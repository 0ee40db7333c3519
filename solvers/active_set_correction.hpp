#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_factor.hpp"
#include "solvers/active_set_problem.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// A spring that has to be added to a matrix, or taken out of it: weight b b' is added, with b = (a_row,
/// slack_sign at the slack of the row) and weight = k or -k.
struct SpringChange {
  int row;
  double slack_sign, weight;

  bool operator==(const SpringChange&) const = default;
};

/// Solves with M_FF + B D B', D = diag(weights), from the factor M_FF = L L', when only a few springs have
/// changed since (Sherman, Morrison, Woodbury):
///
///     inv(M_FF + B D B') = inv(L') (I - W inv(inv(D) + W'W) W') inv(L),    W = inv(L) B.
///
/// The columns of W are kept as long as the factor is the same. All memory is taken at construction.
class ActiveSetCorrection {
 public:
  /// Most changes at a time: with more of them, factoring M_FF + B D B' is less work.
  static constexpr std::size_t kMost = 8;

  ActiveSetCorrection(const ActiveSetProblem& problem, ActiveSetFactor& factor);

  /// Drops all changes; to be called when the factor has changed.
  void clear();

  /// Replaces the changes. Returns false, and keeps none, if there are too many or if they leave too little
  /// of a diagonal for an accurate solution.
  bool assign(const std::vector<SpringChange>& changes);

  /// Solves (M_FF + B D B') x_F = b_F in place: the entries F of `vector` are replaced, the others are kept.
  void solve_in_place(LaneVector& vector);

 private:
  void keep(const std::vector<SpringChange>& changes);
  void add(const SpringChange& change);
  bool factor_small();
  void solve_small(double* b) const;

  using Small = Eigen::Matrix<double, kMost, kMost, Eigen::RowMajor>;

  const ActiveSetProblem& problem_;
  ActiveSetFactor& factor_;
  std::vector<SpringChange> changes_;
  LaneMatrix w_;  ///< W
  Small gram_;    ///< W'W, lower triangle
  Small lower_;   ///< inv(D) + W'W = L D L': L below the diagonal, the reciprocal of D on it
  LaneVector normal_, packed_;
};

}  // namespace mpm
