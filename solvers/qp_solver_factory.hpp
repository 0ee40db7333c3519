#pragma once

#include <string>
#include <vector>

#include "solvers/qp_solver.hpp"

namespace mpm {

/// The factory of the back end with this name; an unknown name throws InputError that lists the known ones.
QpSolverFactory qp_solver_factory(const std::string& name);

/// Names that `qp_solver_factory` knows.
std::vector<std::string> qp_solver_names();

}  // namespace mpm
