#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bench/execution/experiment_execution.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/execution/worker_pool.hpp"
#include "bench/outcome/outcome_bytes.hpp"

namespace mpm {
namespace {

WorkerPool workers_for(const ExecutionPlan& plan) {
  const auto work = std::make_shared<ExperimentWork>(plan.study, plan.basis_study, plan.basis, plan.options,
                                                     qp_solver_factory(plan.options.solver));
  const auto jobs = std::min(static_cast<std::size_t>(plan.options.jobs), plan.indices.size());
  const auto bytes = std::make_shared<OutcomeBytes>(plan.study);
  return WorkerPool(static_cast<int>(jobs), [work, bytes](const std::string& request) {
    ExperimentOutcome outcome = work->run(std::stoll(request));
    work->audit(outcome);
    return bytes->to_bytes(outcome);
  });
}

ExperimentOutcome outcome_of(TaskResult result, const Study& study, const OutcomeBytes& bytes) {
  if (!result.crashed)
    return bytes.from_bytes(result.bytes);
  ExperimentOutcome outcome;
  outcome.record = lost_record(study, result.id, std::move(result.bytes));
  return outcome;
}

}  // namespace

void execute_in_processes(const ExecutionPlan& plan, const StopRequest& stop, const OutcomeSink& deliver) {
  WorkerPool pool = workers_for(plan);
  const OutcomeBytes bytes(plan.study);
  auto next = plan.indices.begin();
  while (!requested(stop) && (next != plan.indices.end() || pool.has_busy())) {
    if (next != plan.indices.end() && pool.has_idle()) {
      pool.start(*next, fmt::to_string(*next));
      ++next;
    } else if (std::optional<TaskResult> result = next_finding(pool, stop)) {
      deliver(outcome_of(std::move(*result), plan.study, bytes));
    }
  }
}

}  // namespace mpm
