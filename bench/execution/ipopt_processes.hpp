#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/execution/experiment_execution.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/execution/worker_pool.hpp"
#include "bench/outcome/outcome_bytes.hpp"

namespace mpm {

/// Worker processes beside threads, for what needs Ipopt. They are forked by the constructor, which must run
/// before the first thread starts.
class IpoptProcesses {
 public:
  /// `options.jobs` processes. What `plan` refers to must outlive them.
  explicit IpoptProcesses(const ExecutionPlan& plan);

  /// An outcome with samples waits for their audit; one without, for its experiment to be run anew.
  void add(ExperimentOutcome outcome) { waiting_.push_back({std::move(outcome)}); }

  /// Works off everything that was added, unless it is to stop.
  void finish(const StopRequest& stop, const OutcomeSink& deliver);

 private:
  struct Task {
    ExperimentOutcome outcome;
    bool once_more = false;  ///< a worker died over its audit
  };

  /// A worker died. An experiment is lost with it; an audit is done once more, and left out when that kills a
  /// worker too: nothing was found out about its steps, neither agreement nor disagreement.
  void take_loss(const TaskResult& result, const OutcomeSink& deliver);

  const Study& study_;
  std::function<void(const std::string&)> warn_;
  OutcomeBytes bytes_;
  std::shared_ptr<ExperimentWork> work_;
  WorkerPool pool_;
  std::deque<Task> waiting_;
  std::vector<Task> under_way_;
};

}  // namespace mpm
