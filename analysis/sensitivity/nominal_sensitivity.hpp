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

/// The operating point at which a study is assessed. The target optimizer chooses it for the nominal model at
/// zero disturbances.
struct OperatingPoint {
  Eigen::VectorXd u;                     ///< nu
  Eigen::VectorXd y;                     ///< ny
  std::vector<ActiveConstraint> active;  ///< CVs at a setpoint or a soft limit
  std::vector<Eigen::Index> fixed_mvs;   ///< MVs at a hard limit: not available for control
};

/// Returns the point at which the loops of the study start (Mpc::nominal_target): the economic optimum at
/// zero disturbances, or the operating point of the model if the MVs have no targets. The active CVs are
/// those with a setpoint and those in `study.sensitivity.active_cvs`, each at its nearest limit; if that list
/// is empty, the CVs at a limit are active instead. The fixed MVs are those at a hard limit and those in
/// `study.sensitivity.fixed_mvs`. Throws InputError if the target problem has no solution.
OperatingPoint operating_point(const Study& study, const QpSolverFactory& factory);

/// Returns the operating point `point` without the MVs in `study.s0_perturbation.fixed_mvs`, which are held
/// where they are. Of the CVs in ranges, only those in `fixed_active_cvs` stay active, each at its nearest
/// limit (each fixed MV costs one degree of freedom).
OperatingPoint with_fixed_mvs(const Study& study, OperatingPoint point);

/// The nominal complementary sensitivity T0 as step responses, and S0 = I - T0 (2.15 to 2.17, 6.3).
///
/// A CV at an active soft limit acts as if the limit were its setpoint. A CV inside its range has no
/// influence on the moves, so that its column of T0 is 0 (6.3 of the thesis, figure 6.5).
///
/// | symbol       | member           | shape           | meaning                                           |
/// |--------------|------------------|-----------------|---------------------------------------------------|
/// | j            | active[a].cv     |                 | a CV with a setpoint or an active limit           |
/// | T0(:, j) / s | step_response[a] | ny x L          | column l-1: outputs l samples after a unit step   |
struct NominalSensitivity {
  Eigen::Index cv_count = 0;
  std::vector<ActiveConstraint> active;
  std::vector<Eigen::MatrixXd> step_response;
  bool is_known = true;  ///< false if the controller cannot be run on its own model: nothing is active

  /// Returns the last values of the step responses, ny x ny; column j is zero if CV j is inside its range.
  Eigen::MatrixXd static_gain() const;
};

/// Returns the outputs of the controller on its own model while one reference moves, as deviations from rest
/// (appendix A3, steps a to l). The limits of the CVs inside their range and of the available MVs are
/// relaxed, MVs at a limit are held there, and there is no noise and no disturbance. `observer` sees each
/// step of the controller.
///
/// | symbol | meaning                                                  | shape  | unit        |
/// |--------|----------------------------------------------------------|--------|-------------|
/// | moves  | deviation of the reference from its value at rest        | N      | of its CV   |
/// | result | column k: outputs at sample k, from moves up to k - 1    | ny x N | of the CVs  |
///
/// @throws InputError if the relaxed controller has no solution
Eigen::MatrixXd reference_record(const Study& study, const OperatingPoint& point,
                                 const ActiveConstraint& reference,
                                 const Eigen::Ref<const Eigen::RowVectorXd>& moves,
                                 const QpSolverFactory& factory, const StepObserver& observer = {});

/// Determines T0 by simulation of the controller on its own model, appendix A3 of the thesis (steps a to p),
/// under the conditions of reference_record(). Each setpoint and each active soft limit in turn makes a step
/// of `study.sensitivity.step_size`: up for a setpoint, in `step_direction` for a limit.
///
/// A controller without targets does not draw a CV to its limit, and no controller does so for a CV that
/// integrates. These active limits are taken to lie where the CVs are, and step into the range whatever
/// `step_direction` says. The thesis fits Box-Jenkins models to these data; with noise-free data of the
/// controller itself, the step response is the model. `observer` sees each step of the relaxed controller.
/// Throws InputError if the relaxed controller has no solution.
NominalSensitivity nominal_sensitivity(const Study& study, const OperatingPoint& point,
                                       const QpSolverFactory& factory, const StepObserver& observer = {});

}  // namespace mpm
