#include "analysis/sensitivity/nominal_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "analysis/sensitivity/active_limit.hpp"
#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/study/study_controller.hpp"
#include "solvers/mpc.hpp"

namespace mpm {
namespace {

ActiveConstraint limit_reference(Eigen::Index cv, bool upper) {
  return {cv, upper ? ConstraintKind::upper_limit : ConstraintKind::lower_limit};
}

ActiveConstraint nearest_limit(const Study& study, Eigen::Index cv, const Eigen::VectorXd& y) {
  const Limits& soft = study.controller.cv_soft;
  return limit_reference(cv, std::abs(soft.upper(cv) - y(cv)) < std::abs(y(cv) - soft.lower(cv)));
}

bool contains(const std::vector<Eigen::Index>& list, Eigen::Index i) {
  return std::find(list.begin(), list.end(), i) != list.end();
}

/// Returns the setpoints and, for those CVs in ranges that are in `cvs`, the nearest limit, in the order of
/// the CVs.
std::vector<ActiveConstraint> references(const Study& study, const std::vector<Eigen::Index>& cvs,
                                         const Eigen::VectorXd& y) {
  std::vector<ActiveConstraint> active;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (study.controller.has_setpoint(cv))
      active.push_back({cv, ConstraintKind::setpoint});
    else if (contains(cvs, cv))
      active.push_back(nearest_limit(study, cv, y));
  return active;
}

std::vector<Eigen::Index> cvs_at_limit(const Study& study, const Eigen::VectorXd& y) {
  const Limits& soft = study.controller.cv_soft;
  std::vector<Eigen::Index> cvs;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (at_limit(y(cv), soft.lower(cv)) || at_limit(y(cv), soft.upper(cv)))
      cvs.push_back(cv);
  return cvs;
}

/// Returns whether the targets make the CV follow a limit that moves away from it. For a CV that integrates,
/// they hold only its rate.
bool is_drawn_to_limit(const Study& study, Eigen::Index cv) {
  return study.controller.has_targets() && !study.plant.G.is_integrating(cv);
}

/// Returns the value of the reference at rest while T0 is determined.
double reference_value(const Study& study, const OperatingPoint& point, const ActiveConstraint& reference) {
  if (reference.kind == ConstraintKind::setpoint || !is_drawn_to_limit(study, reference.cv))
    return point.y(reference.cv);
  const Limits& soft = study.controller.cv_soft;
  return (reference.kind == ConstraintKind::upper_limit ? soft.upper : soft.lower)(reference.cv);
}

/// Returns the limit in `soft` that is the reference.
double& limit_of(Limits& soft, const ActiveConstraint& reference) {
  return (reference.kind == ConstraintKind::upper_limit ? soft.upper : soft.lower)(reference.cv);
}

/// Returns the controller of A3 b and d, in which only the setpoints and the active limits are left.
MpcOptions relaxed_options(const Study& study, const OperatingPoint& point) {
  MpcOptions options = study.controller;
  options.mv_hard = Limits::none(study.mv_count());
  options.move_limit = {};
  for (const Eigen::Index mv : point.fixed_mvs)
    options.mv_hard.lower(mv) = options.mv_hard.upper(mv) = point.u(mv);
  options.cv_hard = Limits::none(study.cv_count());
  options.cv_soft = Limits::none(study.cv_count());
  for (const ActiveConstraint& reference : point.active)
    if (reference.kind != ConstraintKind::setpoint)
      limit_of(options.cv_soft, reference) = reference_value(study, point, reference);
  return options;
}

Eigen::VectorXd setpoints_at_rest(const Study& study, const OperatingPoint& point) {
  Eigen::VectorXd y_set = Eigen::VectorXd::Zero(study.cv_count());
  for (const ActiveConstraint& reference : point.active)
    if (reference.kind == ConstraintKind::setpoint)
      y_set(reference.cv) = reference_value(study, point, reference);
  return y_set;
}

/// Returns the response of the outputs per unit of a step of the reference; `step` is in CV units.
Eigen::MatrixXd reference_response(const Study& study, const OperatingPoint& point,
                                   const ActiveConstraint& reference, double step,
                                   const QpSolverFactory& factory, const StepObserver& observer) {
  const Eigen::Index samples = study.sensitivity.samples;
  const Eigen::RowVectorXd moves = Eigen::RowVectorXd::Constant(samples + 1, step);
  return reference_record(study, point, reference, moves, factory, observer).rightCols(samples) / step;
}

Eigen::MatrixXd directed_response(const Study& study, const OperatingPoint& point,
                                  const ActiveConstraint& reference, const QpSolverFactory& factory,
                                  const StepObserver& observer) {
  const auto response = [&](double step) {
    return reference_response(study, point, reference, step, factory, observer);
  };
  const double size = study.sensitivity.step_size;
  if (reference.kind == ConstraintKind::setpoint)
    return response(size);
  const double into_range = reference.kind == ConstraintKind::upper_limit ? -size : size;
  if (!is_drawn_to_limit(study, reference.cv))
    return response(into_range);
  switch (study.sensitivity.step_direction) {
    case StepDirection::into_range:
      return response(into_range);
    case StepDirection::out_of_range:
      return response(-into_range);
    case StepDirection::mean:
      break;
  }
  return 0.5 * (response(into_range) + response(-into_range));
}

}  // namespace

OperatingPoint operating_point(const Study& study, const QpSolverFactory& factory) {
  Mpc controller(study.plant.G, study.mv_count(), study.controller, factory);
  controller.set_setpoints(study.simulation.initial_setpoint);
  const Eigen::VectorXd d = Eigen::VectorXd::Zero(study.md_count());
  OperatingPoint point;
  point.u = controller.nominal_target(d);
  if (!point.u.allFinite())
    throw InputError("controller", "a target problem without a solution", "MV limits that contain a target");
  Eigen::VectorXd input(study.plant.G.cols());
  input << point.u, d;
  point.y = study.plant.G.steady_output(input);
  const std::vector<Eigen::Index>& named = study.sensitivity.active_cvs;
  point.active = references(study, named.empty() ? cvs_at_limit(study, point.y) : named, point.y);
  const Limits& hard = study.controller.mv_hard;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
    if (contains(study.sensitivity.fixed_mvs, mv) || at_limit(point.u(mv), hard.lower(mv)) ||
        at_limit(point.u(mv), hard.upper(mv)))
      point.fixed_mvs.push_back(mv);
  return point;
}

OperatingPoint with_fixed_mvs(const Study& study, OperatingPoint point) {
  point.active = references(study, study.s0_perturbation.fixed_active_cvs, point.y);
  std::vector<Eigen::Index>& fixed = point.fixed_mvs;
  fixed.insert(fixed.end(), study.s0_perturbation.fixed_mvs.begin(), study.s0_perturbation.fixed_mvs.end());
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  return point;
}

Eigen::MatrixXd NominalSensitivity::static_gain() const {
  Eigen::MatrixXd gain = Eigen::MatrixXd::Zero(cv_count, cv_count);
  for (std::size_t a = 0; a < active.size(); ++a)
    gain.col(active[a].cv) = step_response[a].rightCols<1>();
  return gain;
}

Eigen::MatrixXd reference_record(const Study& study, const OperatingPoint& point,
                                 const ActiveConstraint& reference,
                                 const Eigen::Ref<const Eigen::RowVectorXd>& moves,
                                 const QpSolverFactory& factory, const StepObserver& observer) {
  const MpcOptions options = relaxed_options(study, point);
  const std::unique_ptr<Controller> own = controller_of(study, options, factory);
  Controller& controller = *own;
  const Eigen::VectorXd y_set = setpoints_at_rest(study, point);
  controller.set_setpoints(y_set);
  const Eigen::VectorXd d = Eigen::VectorXd::Zero(study.md_count());
  const Eigen::VectorXd u = controller.nominal_target(d);
  Eigen::VectorXd input(u.size() + d.size());
  input << u, d;
  LinearPlant plant(study.plant.G, study.controller.sample_time);
  plant.reset(input);
  controller.reset(u, d);
  const Eigen::VectorXd rest = plant.output();
  AnalyserHold analysers(options.analysers);
  analysers.reset(rest);
  Eigen::VectorXd measured = rest;

  const auto move_reference = [&](double by) {
    if (reference.kind == ConstraintKind::setpoint) {
      Eigen::VectorXd moved = y_set;
      moved(reference.cv) += by;
      controller.set_setpoints(moved);
    } else {
      Limits moved = options.cv_soft;
      limit_of(moved, reference) += by;
      controller.set_cv_soft(moved);
    }
  };
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(study.cv_count(), moves.size());
  for (Eigen::Index k = 0; k + 1 < moves.size(); ++k) {
    if (k == 0 || moves(k) != moves(k - 1))
      move_reference(moves(k));
    measured = plant.output();
    analysers.pass(measured);
    const ControlMove& move = controller.step(measured, d);
    if (observer)
      observer(controller);
    if (move.status != ControlStatus::ok)
      throw InputError(
          "nominal sensitivity",
          fmt::format("a controller that is {} after a step in the {} of {}{}", to_string(move.status),
                      to_string(reference.kind), study.plant.cvs[static_cast<std::size_t>(reference.cv)].name,
                      move.status == ControlStatus::failed ? fmt::format(" ({})", controller.failure()) : ""),
          "a relaxed controller with a solution (are the active CVs right?)");
    input.head(u.size()) = move.u;
    plant.advance(input);
    y.col(k + 1) = plant.output() - rest;
  }
  return y;
}

NominalSensitivity nominal_sensitivity(const Study& study, const OperatingPoint& point,
                                       const QpSolverFactory& factory, const StepObserver& observer) {
  NominalSensitivity sensitivity{.cv_count = study.cv_count(), .active = point.active, .step_response = {}};
  for (const ActiveConstraint& reference : point.active)
    sensitivity.step_response.push_back(directed_response(study, point, reference, factory, observer));
  return sensitivity;
}

}  // namespace mpm
