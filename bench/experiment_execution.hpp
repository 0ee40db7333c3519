#pragma once

#include <cstdint>
#include <functional>

#include "bench/experiment_work.hpp"

namespace mpm {

/// What is to be run, and how.
struct ExecutionPlan {
  const Study& study;
  const BasisCase& basis;
  SolverPlan solver;
  StorePolicy store = StorePolicy::none;
  std::int64_t count = 0;  ///< experiments 0 <= index < count
  int jobs = 1;            ///< how many run at once
};

/// Takes the outcome of each experiment, its audits done, in the order in which they come.
using OutcomeSink = std::function<void(ExperimentOutcome)>;

/// Runs the experiments in `jobs` worker processes: any solver, and a crash costs one experiment only. The
/// process must have no other thread.
void execute_in_processes(const ExecutionPlan& plan, const OutcomeSink& deliver);

/// Runs the experiments in `jobs` OpenMP threads by the active-set method. Only the solvers `auto` and
/// `active-set` can run so. What needs Ipopt goes to worker processes, which are forked before the first
/// thread starts: audits, and with `auto` the experiments in which some answer was not certified, as a whole.
/// The outcomes are those of execute_in_processes(), bit for bit.
void execute_in_threads(const ExecutionPlan& plan, const OutcomeSink& deliver);

}  // namespace mpm
