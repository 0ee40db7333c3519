#include "bench/experiment_execution.hpp"

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <omp.h>

#include "bench/outcome_bytes.hpp"
#include "bench/worker_pool.hpp"
#include "solvers/certified_solver.hpp"

namespace mpm {
namespace {

/// Experiments a thread between two meetings of the threads: enough that waiting for the last one is little.
constexpr std::int64_t kBatch = 64;

bool needs_reference(const ExperimentRecord& record) {
  return record.status == ExperimentStatus::failed ||
         record.solver.largest_kkt_residual > kCertifiedKktResidual;
}

/// The audit of steps whose worker died: no number, and no agreement either.
void mark_lost(ExperimentOutcome& outcome) {
  for (const AuditSample& sample : outcome.samples) {
    AuditedStep step;
    step.experiment = sample.experiment;
    step.step = sample.step;
    outcome.audited.push_back(step);
  }
  outcome.samples.clear();
}

/// The worker processes beside the threads. A request is an outcome: with samples, their audit is wanted;
/// without, the experiment of its record, run anew.
class ReferenceProcesses {
 public:
  ReferenceProcesses(const ExecutionPlan& plan)
      : study_(plan.study),
        work_(std::make_shared<ExperimentWork>(plan.study, plan.basis, plan.solver, plan.store)),
        pool_(plan.jobs, [work = work_](const std::string& request) { return answer(*work, request); }) {}

  void add(ExperimentOutcome outcome) { waiting_.push_back(std::move(outcome)); }

  /// Works off everything that was added.
  void finish(const OutcomeSink& deliver) {
    while (!waiting_.empty() || pool_.has_busy()) {
      if (!waiting_.empty() && pool_.has_idle()) {
        const auto id = static_cast<std::int64_t>(under_way_.size());
        pool_.start(id, to_bytes(waiting_.front()));
        under_way_.push_back(std::move(waiting_.front()));
        waiting_.pop_front();
        continue;
      }
      const TaskResult result = pool_.wait();
      deliver(result.crashed ? lost(result) : outcome_from_bytes(result.bytes));
    }
    under_way_.clear();
  }

 private:
  static std::string answer(ExperimentWork& work, const std::string& request) {
    ExperimentOutcome outcome = outcome_from_bytes(request);
    if (outcome.samples.empty())
      outcome = work.run(outcome.record.draw.index);
    work.audit(outcome);
    return to_bytes(outcome);
  }

  ExperimentOutcome lost(const TaskResult& result) {
    ExperimentOutcome outcome = std::move(under_way_[static_cast<std::size_t>(result.id)]);
    if (outcome.samples.empty())
      outcome.record = lost_record(study_, outcome.record.draw.index, result.bytes);
    mark_lost(outcome);
    return outcome;
  }

  const Study& study_;
  std::shared_ptr<ExperimentWork> work_;
  WorkerPool pool_;
  std::deque<ExperimentOutcome> waiting_;
  std::vector<ExperimentOutcome> under_way_;
};

}  // namespace

void execute_in_processes(const ExecutionPlan& plan, const OutcomeSink& deliver) {
  const auto work = std::make_shared<ExperimentWork>(plan.study, plan.basis, plan.solver, plan.store);
  WorkerPool pool(static_cast<int>(std::min<std::int64_t>(plan.jobs, plan.count)),
                  [work](const std::string& request) {
                    ExperimentOutcome outcome = work->run(std::stoll(request));
                    work->audit(outcome);
                    return to_bytes(outcome);
                  });
  std::int64_t next = 0;
  while (next < plan.count || pool.has_busy()) {
    if (next < plan.count && pool.has_idle()) {
      pool.start(next, fmt::to_string(next));
      ++next;
      continue;
    }
    TaskResult result = pool.wait();
    if (!result.crashed) {
      deliver(outcome_from_bytes(result.bytes));
      continue;
    }
    ExperimentOutcome outcome;
    outcome.record = lost_record(plan.study, result.id, std::move(result.bytes));
    deliver(std::move(outcome));
  }
}

void execute_in_threads(const ExecutionPlan& plan, const OutcomeSink& deliver) {
  const bool fall_back = plan.solver.solver == "auto";
  std::optional<ReferenceProcesses> reference;
  if (fall_back || plan.solver.audit_share > 0.0)
    reference.emplace(plan);  // before the first thread starts
  SolverPlan in_thread = plan.solver;
  in_thread.solver = "active-set";
  std::vector<std::unique_ptr<ExperimentWork>> work;
  for (int thread = 0; thread < plan.jobs; ++thread)
    work.push_back(std::make_unique<ExperimentWork>(plan.study, plan.basis, in_thread, plan.store));

  const std::int64_t batch = kBatch * plan.jobs;
  std::vector<ExperimentOutcome> outcomes;
  for (std::int64_t first = 0; first < plan.count; first += batch) {
    const std::int64_t size = std::min(batch, plan.count - first);
    outcomes.assign(static_cast<std::size_t>(size), {});
#pragma omp parallel for schedule(dynamic) num_threads(plan.jobs)
    for (std::int64_t i = 0; i < size; ++i)
      outcomes[static_cast<std::size_t>(i)] =
          work[static_cast<std::size_t>(omp_get_thread_num())]->run(first + i);
    for (ExperimentOutcome& outcome : outcomes) {
      if (fall_back && needs_reference(outcome.record))
        outcome.samples.clear();
      else if (outcome.samples.empty()) {
        deliver(std::move(outcome));
        continue;
      }
      reference->add(std::move(outcome));
    }
    if (reference)
      reference->finish(deliver);
  }
}

}  // namespace mpm
