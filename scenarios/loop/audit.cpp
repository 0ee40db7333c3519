#include "scenarios/loop/audit.hpp"

#include <algorithm>
#include <cmath>

#include "base/non_finite.hpp"
#include "solvers/mpc.hpp"

namespace mpm {
namespace {

AuditedProblem copy_of(const SolvedQp& problem) {
  return {problem.data, problem.result.status, problem.result.x, problem.result.objective};
}

AuditDifference compare(const AuditedProblem& problem, const QpResult& ipopt) {
  constexpr double kNone = kNaN;
  AuditDifference difference{problem.status == ipopt.status, kNone, kNone};
  if (problem.status == QpStatus::solved && ipopt.status == QpStatus::solved) {
    difference.x = (problem.x - ipopt.x).lpNorm<Eigen::Infinity>();
    difference.objective =
        std::abs(problem.objective - ipopt.objective) / std::max(1.0, std::abs(ipopt.objective));
  }
  return difference;
}

}  // namespace

AuditSummary summarise(std::span<const AuditedStep> steps) {
  AuditSummary summary;
  summary.steps = static_cast<std::int64_t>(steps.size());
  for (const AuditedStep& step : steps) {
    if (!step.targets.same_status || !step.moves.same_status)
      ++summary.disagreements;
    // fmax ignores the NaN of a problem without an answer.
    summary.largest_target = std::fmax(summary.largest_target, step.targets.x);
    summary.largest_move = std::fmax(summary.largest_move, step.moves.x);
    summary.largest_objective =
        std::fmax(summary.largest_objective, std::fmax(step.targets.objective, step.moves.objective));
  }
  return summary;
}

AuditSampler::AuditSampler(std::uint64_t seed, std::int64_t experiment, double share)
    : stream_(seed, static_cast<std::uint64_t>(experiment), StreamId::audit),
      share_(share),
      experiment_(experiment) {}

void AuditSampler::observe(const Controller& controller) {
  const std::int64_t step = step_++;
  const bool is_picked = stream_.uniform() < share_;
  const std::optional<SolvedQp> moves = controller.move_problem();
  if (!is_picked || !moves)
    return;
  AuditSample sample{experiment_, step, {}, {}};
  if (const std::optional<SolvedQp> targets = controller.target_problem())
    sample.targets = copy_of(*targets);
  if (!sample.targets.posed() || sample.targets.status == QpStatus::solved)
    sample.moves = copy_of(*moves);
  samples_.push_back(std::move(sample));
}

Auditor::Auditor(const Study& study, const QpSolverFactory& unlimited) {
  const QpSolverFactory ipopt = with_time_limit(unlimited, study.controller.solver_time_limit);
  // The controller is needed for the structures of its problems; its own solvers never run.
  const Mpc controller(study.plant.G, study.mv_count(), study.controller, ipopt);
  if (const std::optional<SolvedQp> targets = controller.target_problem())
    targets_ = ipopt(std::make_shared<QpStructure>(targets->structure));
  moves_ = ipopt(std::make_shared<QpStructure>(controller.move_problem()->structure));
}

AuditDifference Auditor::check(const AuditedProblem& problem, QpSolver* ipopt, double& kkt_residual) const {
  if (!problem.posed())
    return {true, 0.0, 0.0};
  const QpResult& result = ipopt->solve_from(problem.data, problem.x);
  if (result.status == QpStatus::solved)
    kkt_residual = std::max(kkt_residual, result.kkt_residual);
  return compare(problem, result);
}

AuditedStep Auditor::check(const AuditSample& sample) {
  AuditedStep step;
  step.experiment = sample.experiment;
  step.step = sample.step;
  step.targets = check(sample.targets, targets_.get(), step.ipopt_kkt_residual);
  step.moves = check(sample.moves, moves_.get(), step.ipopt_kkt_residual);
  return step;
}

}  // namespace mpm
