#pragma once

#include "bench/execution/run_options.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/for_each_with_solver.hpp"

namespace mpm {

/// In as many threads as `run` has jobs, where its solver and the study let it (runs_in_threads()). A call
/// that needs Ipopt, which has no threads, is made again after the others.
ForEachWithSolver in_threads(const Study& study, const RunOptions& run);

}  // namespace mpm
