#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/active_set_limits.hpp"
#include "solvers/active_set_problem.hpp"
#include "solvers/active_set_schur.hpp"
#include "solvers/lanes/lane_vector.hpp"
#include "solvers/qp.hpp"

namespace mpm {

enum class DualOutcome { solved, infeasible, failed };

/// The dual active-set method of Goldfarb & Idnani (Math. Program. 27 (1983) 1-33) in the form with the Schur
/// complement, warm-started with the last working set.
///
/// It meets one limit after another, and drops a limit when its multiplier reaches zero. Nearly parallel
/// limits, which the method of multipliers separates slowly, cost it nothing; its work grows with the square
/// of the number of active limits. The Schur complement depends on the working set only, so that its factor
/// is kept from one program to the next. If Q is only semidefinite, the proximal term 1/2 sigma_j z_j^2 is
/// added, whose centre the caller moves. `solve` allocates nothing.
class DualActiveSet {
 public:
  explicit DualActiveSet(const ActiveSetProblem& problem);

  void reset();

  /// `linear` is c of the problem in z, less sigma times the centre. `infeasible` means only that the method
  /// found a ray, see `ray`.
  DualOutcome solve(const QpData& data, const Eigen::Ref<const Eigen::VectorXd>& linear, double tolerance,
                    int& iterations);

  /// z of the last answer.
  const LaneVector& point() const { return z_; }

  /// Writes x, the slacks and the multipliers.
  void report(QpResult& result) const;

  /// After `infeasible`: multipliers (m) of the hard rows that should prove it.
  const Eigen::VectorXd& ray() const { return ray_; }

 private:
  void warm_start(const QpData& data);
  bool enter(const LimitSide& side, double multiplier, double left);
  void leave(std::size_t k);
  double equilibrate(const QpData& data);
  void refine(const QpData& data, double tolerance);
  void find_free_point();
  void find_point();
  double excess(const QpData& data, const LimitSide& side) const;
  bool find_violated(const QpData& data, double tolerance, LimitSide& worst);
  void gather_slacks();
  void find_products(const LimitSide& side);
  DualOutcome iterate(const QpData& data, double tolerance, int& iterations);
  DualOutcome meet(const QpData& data, const LimitSide& side, int& iterations, int limit);
  void make_ray(const LimitSide& side);
  bool& in_use(LimitKind kind, Eigen::Index index);

  const ActiveSetProblem& problem_;
  LimitGeometry geometry_;
  SchurFactor factor_;
  std::vector<LimitSide> working_;
  Eigen::Index rigid_ = 0;      ///< number of working limits without softness; at most the variables
  Eigen::VectorXd multiplier_;  ///< >= 0 in the direction of `side`, in the order of `working_`
  Eigen::VectorXd products_;    ///< products of a limit with those of the working set
  Eigen::VectorXd lower_;       ///< inv(L) products_, where S = L L'
  Eigen::VectorXd direction_, ray_;
  LaneVector linear_, z_, step_;
  LaneVector row_value_, row_slack_;
  std::vector<SlackRun> slack_runs_;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> used_;  ///< limits in the working set: index x kind
};

}  // namespace mpm
