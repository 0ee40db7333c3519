#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/execution/stop_request.hpp"
#include "bench/outcome/experiment_outcome.hpp"

namespace mpm {

/// The experiments that are to be run.
struct ExecutionPlan {
  const Study& study;
  const Study& basis_study;  ///< whose basis case the methods have learnt from: of calibration loops another
  const BasisCase& basis;
  const RunOptions& options;
  std::vector<std::int64_t> indices;                  ///< each once
  std::function<void(const std::string&)> warn = {};  ///< of what was lost and is done again; none when empty
};

/// Takes the outcome of each experiment, its audits done, in the order in which they come; one call at a
/// time, but from any thread. An exception from it ends the execution and is passed on.
using OutcomeSink = std::function<void(ExperimentOutcome)>;

/// Whether the solver `auto` runs an experiment, which was run by the active-set method, as a whole once more
/// with Ipopt to fall back on: some answer was not certified.
bool needs_ipopt(const ExperimentRecord& record);

// When a stop is requested, both give out no more experiments and return: without those in worker processes,
// which may take minutes, and with those in threads, which take milliseconds, unless they wait for an audit.

/// Runs the experiments in `options.jobs` worker processes: any solver, and a crash costs one experiment
/// only. The process must have no other thread.
void execute_in_processes(const ExecutionPlan& plan, const StopRequest& stop, const OutcomeSink& deliver);

/// Runs the experiments in `options.jobs` threads by the active-set method. Only the solvers `auto`
/// and `active-set` can run so. What needs Ipopt goes to worker processes, which are forked before the first
/// thread starts: audits, and with `auto` the experiments in which some answer was not certified, as a whole.
/// The outcomes are those of execute_in_processes(), bit for bit.
void execute_in_threads(const ExecutionPlan& plan, const StopRequest& stop, const OutcomeSink& deliver);

}  // namespace mpm
