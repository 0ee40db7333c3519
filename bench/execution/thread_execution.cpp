#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "bench/execution/experiment_execution.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/execution/ipopt_processes.hpp"
#include "bench/execution/thread_loop.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

/// How long threads run before what they have added for the processes with Ipopt is worked off: much longer
/// than an experiment, so that waiting for the last one is little, and no more than a killed run may lose.
constexpr std::chrono::seconds kRound(2);

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

using ThreadWork = std::vector<std::unique_ptr<ExperimentWork>>;  // one for each thread

/// Runs experiments of the queue until it gives out no more. No exception may leave the threads: the first
/// one of `deliver` is kept until they have ended.
void run_threads(const ThreadWork& work, IndexQueue& queue, const OutcomeSink& deliver) {
  std::exception_ptr failure;
  std::mutex delivery;
  in_threads(static_cast<int>(work.size()), [&](std::size_t thread) {
    while (const std::optional<std::int64_t> index = queue.take()) {
      ExperimentOutcome outcome = work[thread]->run(*index);
      const std::lock_guard one_at_a_time(delivery);
      try {
        if (!failure)
          deliver(std::move(outcome));
      } catch (...) {
        failure = std::current_exception();
        queue.close();
      }
    }
  });
  if (failure)
    std::rethrow_exception(failure);
}

}  // namespace

bool needs_ipopt(const ExperimentRecord& record) {
  return record.status == ExperimentStatus::failed || record.solver.uncertified > 0;
}

void execute_in_threads(const ExecutionPlan& plan, const StopRequest& stop, const OutcomeSink& deliver) {
  const bool fall_back = plan.options.solver == "auto" && !plan.study.controller_program;
  std::optional<IpoptProcesses> ipopt;
  if (fall_back || audited_share(plan.study, plan.options) > 0.0)
    ipopt.emplace(plan);  // before the first thread starts
  const QpSolverFactory in_thread = qp_solver_factory("active-set");
  ThreadWork work;
  for (int thread = 0; thread < plan.options.jobs; ++thread)
    work.push_back(
        std::make_unique<ExperimentWork>(plan.study, plan.basis_study, plan.basis, plan.options, in_thread));

  const OutcomeSink sort_out = [&](ExperimentOutcome outcome) {
    if (fall_back && needs_ipopt(outcome.record))
      outcome.samples.clear();
    else if (outcome.samples.empty())
      return deliver(std::move(outcome));
    ipopt->add(std::move(outcome));
  };
  IndexQueue queue(plan.indices, stop);
  while (!queue.done()) {
    queue.open_until(ipopt ? Clock::now() + kRound : Clock::time_point::max());
    run_threads(work, queue, sort_out);
    if (ipopt)
      ipopt->finish(stop, deliver);
  }
}

}  // namespace mpm
