#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scenarios/random/random_stream.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/controller.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// A problem and the answer that is to be checked.
struct AuditedProblem {
  /// False if the step did not pose this problem: the controller has no targets, or there were no moves
  /// because the target problem had no answer.
  bool posed() const { return data.gradient.size() > 0; }

  QpData data;
  QpStatus status = QpStatus::numerical_error;
  Eigen::VectorXd x;
  double objective = 0.0;
};

/// The two problems of one step of a controller.
struct AuditSample {
  std::int64_t experiment = 0;
  std::int64_t step = 0;  ///< counted over all loops of the experiment
  AuditedProblem targets, moves;
};

/// How one problem's answer compares with that of Ipopt.
struct AuditDifference {
  bool same_status = false;
  double x = 0.0;          ///< largest difference of a variable, in MV units; NaN unless both are solved
  double objective = 0.0;  ///< difference of the objectives, relative to max(1, |objective|); NaN likewise
};

/// What the audit of one step found.
struct AuditedStep {
  std::int64_t experiment = 0;
  std::int64_t step = 0;
  AuditDifference targets, moves;
  double ipopt_kkt_residual = 0.0;  ///< the larger of its two answers
};

/// What a whole audit found. Without audited steps the largest differences are 0.
struct AuditSummary {
  std::int64_t steps = 0;
  std::int64_t disagreements = 0;  ///< steps where the status of either problem is not Ipopt's
  double largest_target = 0.0;     ///< difference of a target, in MV units
  double largest_move = 0.0;       ///< difference of a planned move, in MV units
  double largest_objective = 0.0;  ///< relative, of either problem
};

AuditSummary summarise(std::span<const AuditedStep> steps);

/// Picks the steps of one experiment that are audited: each with probability `share`, by the random stream
/// `audit` of the experiment, so that the choice depends on nothing else.
class AuditSampler {
 public:
  AuditSampler(std::uint64_t seed, std::int64_t experiment, double share);

  /// To be called after each step (a StepObserver). Picks nothing from a controller that poses no problems.
  void observe(const Controller& controller);

  std::vector<AuditSample> take() { return std::move(samples_); }

 private:
  RandomStream stream_;
  double share_;
  std::int64_t experiment_;
  std::int64_t step_ = 0;
  std::vector<AuditSample> samples_;
};

/// Solves audited problems again with Ipopt. To save time, Ipopt starts from the answer that it checks, but
/// uses nothing else of it; its own answer is certified by its own KKT residual.
class Auditor {
 public:
  Auditor(const Study& study, const QpSolverFactory& ipopt);

  AuditedStep check(const AuditSample& sample);

 private:
  AuditDifference check(const AuditedProblem& problem, QpSolver* ipopt, double& kkt_residual) const;

  std::unique_ptr<QpSolver> targets_, moves_;  ///< targets_ is null for a controller without targets
};

}  // namespace mpm
