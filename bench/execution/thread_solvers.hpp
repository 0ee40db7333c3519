#pragma once

#include "bench/execution/run_options.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/for_each_with_solver.hpp"

namespace mpm {

/// Makes calls in as many threads as `run` has jobs, if its solver and the study allow threads
/// (runs_in_threads()). A call that needs Ipopt, which must not run in threads, is made again after the
/// others.
ForEachWithSolver in_threads(const Study& study, const RunOptions& run);

}  // namespace mpm
