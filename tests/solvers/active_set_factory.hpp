#pragma once

#include "solvers/qp_solver.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm::testing {

/// Tests that do not compare solvers use this one.
inline const QpSolverFactory kFactory = qp_solver_factory("active-set");

}  // namespace mpm::testing
