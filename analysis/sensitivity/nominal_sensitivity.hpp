#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The value at which the controller holds a CV.
enum class ConstraintKind : std::int8_t { lower_limit = 0, upper_limit = 1, setpoint = 2 };

template <>
inline constexpr auto kWords<ConstraintKind> = word_list("lower limit", "upper limit", "setpoint");

/// A CV at its setpoint, or at one of its soft limits.
struct ActiveConstraint {
  Eigen::Index cv;
  ConstraintKind kind;

  auto operator<=>(const ActiveConstraint&) const = default;
};

/// The operating point at which a study is assessed: what the target optimizer chooses for the nominal model
/// at zero disturbances.
struct OperatingPoint {
  Eigen::VectorXd u;                     ///< nu
  Eigen::VectorXd y;                     ///< ny
  std::vector<ActiveConstraint> active;  ///< CVs at a setpoint or a soft limit
  std::vector<Eigen::Index> fixed_mvs;   ///< MVs at a hard limit: not available for control
};

/// Where the loops of the study start (Mpc::nominal_target): the economic optimum at zero disturbances,
/// or the operating point of the model when the MVs have no targets. Active are the CVs with a setpoint, and
/// with `study.sensitivity.active_cvs` those, at the limit they are nearest to; without that list the CVs
/// that are at a limit. Fixed are the MVs at a hard limit and those of `study.sensitivity.fixed_mvs`. Throws
/// InputError when the target problem has no solution.
OperatingPoint operating_point(const Study& study, const QpSolverFactory& factory);

/// The operating point `point` when the MVs of `study.s0_perturbation.fixed_mvs` are not available: they are
/// held where they are, and of the CVs in ranges those of `fixed_active_cvs` stay at the limit they are
/// nearest to (one degree of freedom is lost with each MV).
OperatingPoint with_fixed_mvs(const Study& study, OperatingPoint point);

/// The nominal complementary sensitivity T0 as step responses, and S0 = I - T0 (2.15 to 2.17, 6.3).
///
/// A CV at an active soft limit acts as if the limit were its setpoint; a CV inside its range has no
/// influence on the moves, and T0 = 0 from it (6.3 of the thesis, figure 6.5).
///
/// | symbol       | member           | shape           | meaning                                           |
/// |--------------|------------------|-----------------|---------------------------------------------------|
/// | j            | active[a].cv     |                 | a CV with a setpoint or an active limit           |
/// | T0(:, j) / s | step_response[a] | ny x L          | column l-1: outputs l samples after a unit step   |
struct NominalSensitivity {
  Eigen::Index cv_count = 0;
  std::vector<ActiveConstraint> active;
  std::vector<Eigen::MatrixXd> step_response;
  bool is_known = true;  ///< not of a controller that cannot be run on its own model: then nothing is active

  /// Last values of the step responses, ny x ny; column j is zero for a CV inside its range.
  Eigen::MatrixXd static_gain() const;
};

/// Outputs of the controller on its own model while one reference moves, as deviations from rest (appendix
/// A3, steps a to l): limits of the CVs inside their range and of the available MVs relaxed, MVs at a limit
/// held there, no noise and no disturbance. `observer` sees each step of the controller.
///
/// | symbol | meaning                                                  | shape  | unit        |
/// |--------|----------------------------------------------------------|--------|-------------|
/// | moves  | deviation of the reference from where it lies            | N      | of its CV   |
/// | result | column k: outputs at sample k, from moves up to k - 1    | ny x N | of the CVs  |
///
/// @throws InputError when the relaxed controller has no solution
Eigen::MatrixXd reference_record(const Study& study, const OperatingPoint& point,
                                 const ActiveConstraint& reference,
                                 const Eigen::Ref<const Eigen::RowVectorXd>& moves,
                                 const QpSolverFactory& factory, const StepObserver& observer = {});

/// T0 by simulation of the controller on its own model, appendix A3 of the thesis (steps a to p): limits of
/// the CVs inside their range and of the available MVs relaxed, MVs at a limit held there, no noise and no
/// disturbance, then for each setpoint and each active soft limit in turn a step of
/// `study.sensitivity.step_size`: up for a setpoint, `step_direction` for a limit. A controller without
/// targets has nothing that draws a CV to its limit, nor has any controller for a CV that integrates: these
/// active limits are taken to lie where the CVs are, and are stepped into the range whatever `step_direction`
/// says. The thesis fits Box-Jenkins models to these
/// data; with noise-free data of the controller itself the step response is the model. `observer` sees each
/// step of the relaxed controller. Throws InputError when that has no solution.
NominalSensitivity nominal_sensitivity(const Study& study, const OperatingPoint& point,
                                       const QpSolverFactory& factory, const StepObserver& observer = {});

}  // namespace mpm
