#include "scenarios/audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm {
namespace {

AuditedProblem copy_of(const SolvedQp& problem) {
  return {problem.data, problem.result.status, problem.result.x, problem.result.objective};
}

AuditDifference compare(const AuditedProblem& problem, const QpResult& reference) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  AuditDifference difference{problem.status == reference.status, kNone, kNone};
  if (problem.status == QpStatus::solved && reference.status == QpStatus::solved) {
    difference.x = (problem.x - reference.x).lpNorm<Eigen::Infinity>();
    difference.objective =
        std::abs(problem.objective - reference.objective) / std::max(1.0, std::abs(reference.objective));
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
    // fmax passes over the NaN of a problem without an answer.
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

void AuditSampler::observe(const RangeMpc& controller) {
  const std::int64_t step = step_++;
  if (!(stream_.uniform() < share_))
    return;
  AuditSample sample{experiment_, step, copy_of(controller.target_problem()), {}};
  if (sample.targets.status == QpStatus::solved)  // otherwise the moves are of an earlier step
    sample.moves = copy_of(controller.move_problem());
  samples_.push_back(std::move(sample));
}

Auditor::Auditor(const Study& study, const QpSolverFactory& reference) {
  // The controller makes the structures; its own solvers are never asked.
  const RangeMpc controller(study.plant.G, study.mv_count(), study.controller, reference);
  targets_ = reference(std::make_shared<QpStructure>(controller.target_problem().structure));
  moves_ = reference(std::make_shared<QpStructure>(controller.move_problem().structure));
}

AuditedStep Auditor::check(const AuditSample& sample) {
  AuditedStep step;
  step.experiment = sample.experiment;
  step.step = sample.step;
  const QpResult& targets = targets_->solve_from(sample.targets.data, sample.targets.x);
  step.targets = compare(sample.targets, targets);
  step.moves = {true, 0.0, 0.0};
  if (targets.status == QpStatus::solved)
    step.reference_kkt_residual = targets.kkt_residual;
  if (sample.targets.status != QpStatus::solved)
    return step;
  const QpResult& moves = moves_->solve_from(sample.moves.data, sample.moves.x);
  step.moves = compare(sample.moves, moves);
  if (moves.status == QpStatus::solved)
    step.reference_kkt_residual = std::max(step.reference_kkt_residual, moves.kkt_residual);
  return step;
}

}  // namespace mpm
