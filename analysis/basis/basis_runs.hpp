#pragma once

#include "analysis/basis/basis_case.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// Runs the basis case of the study. `observer` sees each step of its loops, including those that give T0; an
/// exception from it ends the basis case and is passed on. Throws InputError if the sensitivity cannot be
/// determined, or if the plant has no steady state where the loops begin.
BasisCase run_basis_case(const Study& study, const QpSolverFactory& factory,
                         const StepObserver& observer = {});

/// The basis case of a world of the study. Operating point, S0 and diagnosis belong to the model and are
/// those of `basis`, the basis case of the study; the loop is the benchmark of the world. Nothing is checked.
BasisCase world_basis(const Study& study, const BasisCase& basis, int world, const QpSolverFactory& factory);

}  // namespace mpm
