#include "bench/execution/ipopt_processes.hpp"

#include <optional>
#include <string>
#include <utility>

#include "bench/outcome/outcome_bytes.hpp"

namespace mpm {
namespace {

std::string answer(ExperimentWork& work, const OutcomeBytes& bytes, const std::string& request) {
  ExperimentOutcome outcome = bytes.from_bytes(request);
  if (outcome.samples.empty())
    outcome = work.run(outcome.record.draw.index);
  work.audit(outcome);
  return bytes.to_bytes(outcome);
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

}  // namespace

IpoptProcesses::IpoptProcesses(const ExecutionPlan& plan)
    : study_(plan.study),
      bytes_(plan.study),
      work_(std::make_shared<ExperimentWork>(plan.study, plan.basis, plan.options,
                                             qp_solver_factory(plan.options.solver))),
      pool_(plan.options.jobs, [work = work_, &bytes = bytes_](const std::string& request) {
        return answer(*work, bytes, request);
      }) {}

void IpoptProcesses::finish(const StopRequest& stop, const OutcomeSink& deliver) {
  while (!requested(stop) && (!waiting_.empty() || pool_.has_busy())) {
    if (!waiting_.empty() && pool_.has_idle()) {
      const auto id = static_cast<std::int64_t>(under_way_.size());
      pool_.start(id, bytes_.to_bytes(waiting_.front()));
      under_way_.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
      continue;
    }
    if (const std::optional<TaskResult> result = next_finding(pool_, stop))
      deliver(result->crashed ? lost(*result) : bytes_.from_bytes(result->bytes));
  }
  under_way_.clear();
}

ExperimentOutcome IpoptProcesses::lost(const TaskResult& result) {
  ExperimentOutcome outcome = std::move(under_way_[static_cast<std::size_t>(result.id)]);
  if (outcome.samples.empty())
    outcome.record = lost_record(study_, outcome.record.draw.index, result.bytes);
  mark_lost(outcome);
  return outcome;
}

}  // namespace mpm
