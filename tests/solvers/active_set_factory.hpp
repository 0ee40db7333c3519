#pragma once

#include "solvers/qp_solver.hpp"

namespace mpm::testing {

/// Tests that do not compare solvers use this one.
inline const QpSolverFactory kFactory = qp_solver_factory("active-set");

}  // namespace mpm::testing
