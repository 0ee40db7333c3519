#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_dual.hpp"
#include "solvers/active_set_newton.hpp"
#include "solvers/active_set_problem.hpp"
#include "solvers/active_set_springs.hpp"
#include "solvers/linear_vertex.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

struct ActiveSetOptions {
  /// Largest violation of a limit, and largest error of stationarity and complementarity relative to
  /// max(1, |g|), of an answer `solved`.
  double tolerance = 1e-10;
  /// Most Newton steps of one solve, all rounds together.
  int iteration_limit = 1000;
  /// Most rounds of multipliers and proximal centres of one solve.
  int round_limit = 200;
  /// Whether a program without an answer is tried again in units in which its numbers are of similar size.
  bool equilibrate = true;

  /// Throws InputError when a number is out of range.
  void validate() const;
};

/// Our own back end: a warm-started active-set method for the sequences of QPs of a controller.
///
/// Soft limits with a slack of their own are penalties; Newton's method with an exact line search finds the
/// minimiser of the resulting piecewise quadratic over the box in a few steps, exactly. Limits that must hold
/// (hard limits, soft limits that share a slack) are handled by the method of multipliers around it; shared
/// slacks are first tried by a dual active-set method. If the Hessian is only semidefinite (the target
/// optimizer, a linear program), proximal terms are added and taken back (docs/active_set.md). While the
/// active limits of a linear program stay the same, its next answer is their vertex. A program to which all
/// this finds no answer is tried once more in other units (EquilibratedProgram).
///
/// `infeasible` is returned only with a certificate, see `certificate`. `iteration_limit` and
/// `numerical_error` mean that there is no answer; an unbounded problem ends with one of them.
///
/// Among several minimisers (H semidefinite) the answer is the one nearest to the origin in the directions
/// that H leaves open, provided that the proximal weight is small against the costs (Mangasarian & Meyer,
/// SIAM J. Control Optim. 17 (1979) 745-752).
///
/// `solve` allocates nothing, except for the first program that is tried in other units. Solvers of different
/// threads share nothing but the structure.
class ActiveSetSolver final : public QpSolver {
 public:
  /// Throws InputError when the structure or an option is not valid.
  ActiveSetSolver(std::shared_ptr<const QpStructure> structure, const ActiveSetOptions& options);
  ~ActiveSetSolver() override;

  /// After an answer `infeasible`: y (m) with sum |y_i| = 1 that proves a violation of the hard limits, see
  /// `proven_violation`. Zero otherwise.
  const Eigen::VectorXd& certificate() const { return certificate_; }

 private:
  void do_solve(const QpData& data, QpResult& result) override;
  void do_reset() override;

  void search(const QpData& data, QpResult& result);
  void solve_equilibrated(const QpData& data, QpResult& result);
  void reset_newton();
  bool solve_by_dual(const QpData& data, QpResult& result);
  DualOutcome iterate_dual(const QpData& data, int& iterations);
  void solve_by_newton(const QpData& data, QpResult& result);
  void bind_costs(const QpData& data);
  void bind_limits(const QpData& data);
  QpStatus iterate(const QpData& data, int& iterations);
  void set_limits(const QpData& data);
  bool hard_limits_kept(const QpData& data) const;
  void stiffen(double factor);
  double update_multipliers(double scale);
  bool proves_infeasible(const QpData& data, const Eigen::VectorXd& y);
  void report(QpResult& result) const;

  ActiveSetOptions options_;
  ActiveSetProblem problem_;
  std::vector<LimitSprings> families_;
  ActiveSetNewton newton_;
  DualActiveSet dual_;
  std::optional<LinearVertex> vertex_;    ///< of a linear program
  Eigen::VectorXd centre_, dual_linear_;  ///< dual method: proximal centre, and costs with the proximal term
  Eigen::VectorXd certificate_;
  Eigen::VectorXd change_;  ///< change of the multipliers of the hard rows in the last round
  Eigen::VectorXd scratch_;
  double stiffening_ = 1.0;  ///< factor on the stiffness of springs with multipliers, in this solve

  struct Equilibrated;
  std::unique_ptr<Equilibrated> equilibrated_;  ///< made when first needed
};

}  // namespace mpm
