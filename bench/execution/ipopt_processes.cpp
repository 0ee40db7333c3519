#include "bench/execution/ipopt_processes.hpp"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

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

}  // namespace

IpoptProcesses::IpoptProcesses(const ExecutionPlan& plan)
    : study_(plan.study),
      warn_(plan.warn),
      bytes_(plan.study),
      work_(std::make_shared<ExperimentWork>(plan.study, plan.basis_study, plan.basis, plan.options,
                                             qp_solver_factory(plan.options.solver))),
      pool_(plan.options.jobs, [work = work_, &bytes = bytes_](const std::string& request) {
        return answer(*work, bytes, request);
      }) {}

void IpoptProcesses::finish(const StopRequest& stop, const OutcomeSink& deliver) {
  while (!requested(stop) && (!waiting_.empty() || pool_.has_busy())) {
    if (!waiting_.empty() && pool_.has_idle()) {
      const auto id = static_cast<std::int64_t>(under_way_.size());
      pool_.start(id, bytes_.to_bytes(waiting_.front().outcome));
      under_way_.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
      continue;
    }
    const std::optional<TaskResult> result = next_finding(pool_, stop);
    if (result && result->crashed)
      take_loss(*result, deliver);
    else if (result)
      deliver(bytes_.from_bytes(result->bytes));
  }
  under_way_.clear();
}

void IpoptProcesses::take_loss(const TaskResult& result, const OutcomeSink& deliver) {
  Task task = std::move(under_way_[static_cast<std::size_t>(result.id)]);
  const std::int64_t index = task.outcome.record.draw.index;
  if (task.outcome.samples.empty()) {
    task.outcome.record = lost_record(study_, index, result.bytes);
    return deliver(std::move(task.outcome));
  }
  if (warn_)
    warn_(fmt::format("the audit of {} steps of experiment {} was lost: {}; they are {}",
                      task.outcome.samples.size(), index, result.bytes,
                      task.once_more ? "left out of the audit" : "audited again"));
  if (task.once_more) {
    task.outcome.samples.clear();
    return deliver(std::move(task.outcome));
  }
  task.once_more = true;
  waiting_.push_front(std::move(task));
}

}  // namespace mpm
