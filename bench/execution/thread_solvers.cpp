#include "bench/execution/thread_solvers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "bench/execution/thread_loop.hpp"
#include "solvers/certified_solver.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {

ForEachWithSolver in_threads(const Study& study, const RunOptions& run) {
  const QpSolverFactory factory = qp_solver_factory(run.solver);
  if (!runs_in_threads(study, run))
    return in_turn(factory);
  return [factory, jobs = static_cast<std::size_t>(run.jobs)](std::size_t count, const auto& body) {
    std::vector<std::int64_t> left(count, 0);  // problems that need Ipopt
    for_each_in_threads(count, static_cast<int>(std::min(jobs, count)), [&](std::size_t i, std::size_t) {
      body(i, [&left, i](std::shared_ptr<const QpStructure> structure) {
        return std::make_unique<CertifiedSolver>(std::move(structure), &left[i]);
      });
    });
    for (std::size_t i = 0; i < count; ++i)
      if (left[i] > 0)
        body(i, factory);
  };
}

}  // namespace mpm
