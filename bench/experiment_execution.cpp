#include "bench/experiment_execution.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
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

using Clock = std::chrono::steady_clock;

/// How often a waiting process looks whether it is to stop.
constexpr std::chrono::milliseconds kLook(100);

/// How long threads run before what they have added for the reference processes is worked off: much longer
/// than an experiment, so that waiting for the last one is little, and no more than a killed run may lose.
constexpr std::chrono::seconds kRound(2);

bool needs_reference(const ExperimentRecord& record) {
  return record.status == ExperimentStatus::failed ||
         record.solver.largest_kkt_residual > kCertifiedKktResidual;
}

bool requested(const StopRequest& stop) {
  return stop && stop();
}

/// A worker that dies after a stop was requested may have died of the same signal: that says nothing about
/// its experiment, which a resumed run will run again.
bool is_finding(const std::optional<TaskResult>& result, const StopRequest& stop) {
  return result && !(result->crashed && requested(stop));
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

  /// Works off everything that was added, unless it is to stop.
  void finish(const OutcomeSink& deliver, const StopRequest& stop) {
    while (!requested(stop) && (!waiting_.empty() || pool_.has_busy())) {
      if (!waiting_.empty() && pool_.has_idle()) {
        const auto id = static_cast<std::int64_t>(under_way_.size());
        pool_.start(id, to_bytes(waiting_.front()));
        under_way_.push_back(std::move(waiting_.front()));
        waiting_.pop_front();
        continue;
      }
      const std::optional<TaskResult> result = pool_.wait_for(kLook);
      if (is_finding(result, stop))
        deliver(result->crashed ? lost(*result) : outcome_from_bytes(result->bytes));
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

/// Gives out the experiments of a plan, one by one, to threads that ask for them.
class IndexQueue {
 public:
  IndexQueue(const std::vector<std::int64_t>& indices, const StopRequest& stop)
      : indices_(indices), stop_(stop) {}

  bool done() const { return next_ >= indices_.size() || closed_ || requested(stop_); }

  /// Gives out what is left, until `end`. By one thread, before the others ask.
  void open_until(Clock::time_point end) { end_ = end; }
  /// Gives out no more.
  void close() { closed_ = true; }

  /// The next experiment; none when there is none, the time is over, or it is to stop.
  std::optional<std::int64_t> take() {
    if (done() || Clock::now() >= end_)
      return std::nullopt;
    const std::size_t position = next_++;  // several threads may pass the end
    return position < indices_.size() ? std::optional(indices_[position]) : std::nullopt;
  }

 private:
  const std::vector<std::int64_t>& indices_;
  const StopRequest& stop_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> closed_{false};
  Clock::time_point end_;
};

using ThreadWork = std::vector<std::unique_ptr<ExperimentWork>>;  // one a thread

/// Runs experiments of the queue until it gives out no more. No exception may leave the threads: the first
/// one of `deliver` is kept until they have ended.
void run_threads(const ThreadWork& work, IndexQueue& queue, const OutcomeSink& deliver) {
  std::exception_ptr failure;
#pragma omp parallel num_threads(static_cast <int>(work.size()))
  while (const std::optional<std::int64_t> index = queue.take()) {
    ExperimentOutcome outcome = work[static_cast<std::size_t>(omp_get_thread_num())]->run(*index);
#pragma omp critical(mpm_deliver)
    try {
      if (!failure)
        deliver(std::move(outcome));
    } catch (...) {
      failure = std::current_exception();
      queue.close();
    }
  }
  if (failure)
    std::rethrow_exception(failure);
}

}  // namespace

void execute_in_processes(const ExecutionPlan& plan, const OutcomeSink& deliver) {
  const auto work = std::make_shared<ExperimentWork>(plan.study, plan.basis, plan.solver, plan.store);
  WorkerPool pool(static_cast<int>(std::min(static_cast<std::size_t>(plan.jobs), plan.indices.size())),
                  [work](const std::string& request) {
                    ExperimentOutcome outcome = work->run(std::stoll(request));
                    work->audit(outcome);
                    return to_bytes(outcome);
                  });
  auto next = plan.indices.begin();
  while (!requested(plan.stop) && (next != plan.indices.end() || pool.has_busy())) {
    if (next != plan.indices.end() && pool.has_idle()) {
      pool.start(*next, fmt::to_string(*next));
      ++next;
      continue;
    }
    std::optional<TaskResult> result = pool.wait_for(kLook);
    if (!is_finding(result, plan.stop))
      continue;
    if (!result->crashed) {
      deliver(outcome_from_bytes(result->bytes));
      continue;
    }
    ExperimentOutcome outcome;
    outcome.record = lost_record(plan.study, result->id, std::move(result->bytes));
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
  ThreadWork work;
  for (int thread = 0; thread < plan.jobs; ++thread)
    work.push_back(std::make_unique<ExperimentWork>(plan.study, plan.basis, in_thread, plan.store));

  const OutcomeSink sort_out = [&](ExperimentOutcome outcome) {
    if (fall_back && needs_reference(outcome.record))
      outcome.samples.clear();
    else if (outcome.samples.empty())
      return deliver(std::move(outcome));
    reference->add(std::move(outcome));
  };
  IndexQueue queue(plan.indices, plan.stop);
  while (!queue.done()) {
    queue.open_until(reference ? Clock::now() + kRound : Clock::time_point::max());
    run_threads(work, queue, sort_out);
    if (reference)
      reference->finish(deliver, plan.stop);
  }
}

}  // namespace mpm
