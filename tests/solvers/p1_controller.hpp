#pragma once

#include "solvers/mpc_options.hpp"

namespace mpm::samples {

/// Tuning and constraints of the range MPC of P1 ("shell-7x3"): thesis, table 6.2. Q_du = 25 and Q_u = 1
/// count as the weights themselves.
MpcOptions p1_options();

}  // namespace mpm::samples
