#pragma once

#include <compare>
#include <vector>

#include <Eigen/Core>

#include "analysis/nominal_sensitivity.hpp"
#include "scenarios/closed_loop.hpp"

namespace mpm {

/// Which constraints a controller works at: it is linear as long as they stay the same, and has an S0 of its
/// own for each set (3.3.3, 6.3).
struct ControlStructure {
  std::vector<ActiveReference> active;  ///< CVs at a setpoint or a soft limit, in their order
  std::vector<Eigen::Index> fixed_mvs;  ///< MVs at a hard limit, in their order

  auto operator<=>(const ControlStructure&) const = default;
};

/// The structure at each sample of a loop, from its data alone:
///
/// | controller      | an MV is fixed when        | a CV in a range is active when |
/// |-----------------|----------------------------|-----------------------------------------------------------|
/// | with targets    | its target is at a limit   | K u_target + K_d d + (y - y_sim) is at or over a limit:
/// the | |                 |                            | steady state that the optimizer (6.19) aims at | |
/// without targets | it is at a limit           | y is over a limit (3.3.5)                                 |
///
/// A CV with a setpoint is always active. `y_sim` (ny x N) is that of the loop.
std::vector<ControlStructure> control_structures(const Study& study, const Trajectory& loop,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& y_sim);

}  // namespace mpm
