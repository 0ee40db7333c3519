// One experiment of a shipped study, and what each of its methods says of the loop.

#include <cstdio>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/study_files/study_file.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/qp_solver_factory.hpp"

int main() {
  const mpm::Study study = mpm::load_study(WOOD_BERRY);
  const mpm::QpSolverFactory solver = mpm::qp_solver_factory("auto");
  const mpm::BasisCase basis = mpm::run_basis_case(study, solver);

  mpm::ExperimentRunner runner(study, basis, study.methods, solver);
  const mpm::ExperimentRecord record = runner.run(3, mpm::StorePolicy::none);

  for (std::size_t i = 0; i < record.assessments.size(); ++i)
    std::printf("%s: %s\n", study.methods[i].c_str(), record.assessments[i].flagged ? "flagged" : "healthy");
}
