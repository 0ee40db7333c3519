#pragma once

#include <compare>
#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "scenarios/loop/closed_loop.hpp"

namespace mpm {

/// The constraints at which a controller works. The controller is linear as long as they stay the same, so
/// that each set of constraints has an S0 (3.3.3, 6.3).
struct ControlStructure {
  std::vector<ActiveConstraint> active;  ///< CVs at a setpoint or a soft limit, in their order
  std::vector<Eigen::Index> fixed_mvs;   ///< MVs at a hard limit, in their order

  auto operator<=>(const ControlStructure&) const = default;
};

/// Returns the steady state of the CVs at which the target optimizer aims (2.32, 6.19), ny x N:
///
///     K u_target(k) + K_d d(k) + y(k) - y_sim(k)
///
/// with the static gains K of the MVs and K_d of the MDs, and the output bias y(k) - y_sim(k) of the
/// controller. For a CV that integrates it is y(k).
Eigen::MatrixXd optimizer_steady_state(const Study& study, const Trajectory& loop,
                                       const Eigen::Ref<const Eigen::MatrixXd>& y_sim);

/// Determines the structure at each sample of a loop from its data alone. A CV with a setpoint is always
/// active. A CV in a range is active when its deciding output is at or beyond a limit, and an MV is fixed
/// when its deciding input is at a limit. While they are off, a CV is not active and an MV is fixed.
///
/// | controller      | deciding inputs | deciding outputs                                  |
/// |-----------------|-----------------|---------------------------------------------------|
/// | with targets    | u_target        | optimizer_steady_state()                          |
/// | without targets | u               | y (3.3.5)                                         |
///
/// `y_sim` (ny x N) is that of the loop.
std::vector<ControlStructure> control_structures(const Study& study, const Trajectory& loop,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& y_sim);

}  // namespace mpm
