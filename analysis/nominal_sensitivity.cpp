#include "analysis/nominal_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "plants/linear_plant.hpp"
#include "solvers/range_mpc.hpp"

namespace mpm {
namespace {

// The optimizer's vertex is exact to the solver's tolerance; a limit is active well above that.
constexpr double kActiveTolerance = 1e-5;

bool at(double value, double limit) {
  return std::isfinite(limit) && std::abs(value - limit) <= kActiveTolerance * std::max(1.0, std::abs(limit));
}

std::vector<ActiveLimit> nearest_limits(const Study& study, const std::vector<Eigen::Index>& cvs,
                                        const Eigen::VectorXd& y) {
  const Limits& soft = study.controller.cv_soft;
  std::vector<ActiveLimit> nearest;
  for (const Eigen::Index cv : cvs)
    nearest.push_back({cv, std::abs(soft.upper(cv) - y(cv)) < std::abs(y(cv) - soft.lower(cv))});
  return nearest;
}

std::vector<ActiveLimit> active_limits(const Study& study, const Eigen::VectorXd& y) {
  const Limits& soft = study.controller.cv_soft;
  std::vector<ActiveLimit> active;
  if (!study.sensitivity.active_cvs.empty())
    return nearest_limits(study, study.sensitivity.active_cvs, y);
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (at(y(cv), soft.lower(cv)) || at(y(cv), soft.upper(cv)))
      active.push_back({cv, at(y(cv), soft.upper(cv))});
  return active;
}

/// The controller of A3 b and d: only the active limits are left.
RangeMpcOptions relaxed_options(const Study& study, const OperatingPoint& point) {
  RangeMpcOptions options = study.controller;
  options.mv_hard = Limits::none(study.mv_count());
  for (const Eigen::Index mv : point.fixed_mvs)
    options.mv_hard.lower(mv) = options.mv_hard.upper(mv) = point.u(mv);
  options.cv_hard = Limits::none(study.cv_count());
  options.cv_soft = Limits::none(study.cv_count());
  for (const auto [cv, upper] : point.active)
    (upper ? options.cv_soft.upper : options.cv_soft.lower)(cv) =
        (upper ? study.controller.cv_soft.upper : study.controller.cv_soft.lower)(cv);
  return options;
}

/// Response of the outputs per unit of a step of the limit, `step` in CV units.
Eigen::MatrixXd limit_step_response(const Study& study, const OperatingPoint& point, const ActiveLimit& limit,
                                    double step, const QpSolverFactory& factory) {
  const RangeMpcOptions options = relaxed_options(study, point);
  RangeMpc controller(study.plant.G, study.mv_count(), options, factory);
  const Eigen::VectorXd d = Eigen::VectorXd::Zero(study.md_count());
  const Eigen::VectorXd u = controller.nominal_target(d);
  Eigen::VectorXd input(u.size() + d.size());
  input << u, d;
  LinearPlant plant(study.plant.G, study.controller.sample_time);
  plant.reset(input);
  controller.reset(u, d);
  const Eigen::VectorXd rest = plant.output();

  Limits stepped = options.cv_soft;
  (limit.upper ? stepped.upper : stepped.lower)(limit.cv) += step;
  controller.set_cv_soft(stepped);

  Eigen::MatrixXd response(study.cv_count(), study.sensitivity.samples);
  for (Eigen::Index l = 0; l < response.cols(); ++l) {
    const ControlMove& move = controller.step(plant.output(), d);
    if (move.status != ControlStatus::ok)
      throw InputError(
          "nominal sensitivity",
          fmt::format("a controller that is {} after a step in the limit of {}", to_string(move.status),
                      study.plant.cvs[static_cast<std::size_t>(limit.cv)].name),
          "a relaxed controller with a solution (are the active CVs right?)");
    input.head(u.size()) = move.u;
    plant.advance(input);
    response.col(l) = (plant.output() - rest) / step;
  }
  return response;
}

Eigen::MatrixXd directed_response(const Study& study, const OperatingPoint& point, const ActiveLimit& limit,
                                  const QpSolverFactory& factory) {
  const double into_range = limit.upper ? -study.sensitivity.step_size : study.sensitivity.step_size;
  switch (study.sensitivity.step_direction) {
    case StepDirection::into_range:
      return limit_step_response(study, point, limit, into_range, factory);
    case StepDirection::out_of_range:
      return limit_step_response(study, point, limit, -into_range, factory);
    case StepDirection::mean:
      break;
  }
  return 0.5 * (limit_step_response(study, point, limit, into_range, factory) +
                limit_step_response(study, point, limit, -into_range, factory));
}

}  // namespace

OperatingPoint operating_point(const Study& study, const QpSolverFactory& factory) {
  RangeMpc controller(study.plant.G, study.mv_count(), study.controller, factory);
  const Eigen::VectorXd d = Eigen::VectorXd::Zero(study.md_count());
  OperatingPoint point;
  point.u = controller.nominal_target(d);
  if (!point.u.allFinite())
    throw InputError("controller", "a target problem without a solution", "MV limits that contain a target");
  point.y = study.plant.G.static_gain().leftCols(study.mv_count()) * point.u;
  point.active = active_limits(study, point.y);
  const Limits& hard = study.controller.mv_hard;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
    if (at(point.u(mv), hard.lower(mv)) || at(point.u(mv), hard.upper(mv)))
      point.fixed_mvs.push_back(mv);
  return point;
}

OperatingPoint with_fixed_mvs(const Study& study, OperatingPoint point) {
  point.active = nearest_limits(study, study.s0_perturbation.fixed_active_cvs, point.y);
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

double NominalSensitivity::unsettled() const {
  double largest = 0.0;
  for (const Eigen::MatrixXd& response : step_response) {
    const Eigen::Index tail = std::max<Eigen::Index>(1, response.cols() / 10);
    const Eigen::MatrixXd change = response.rightCols(tail).colwise() - response.rightCols<1>().col(0);
    largest = std::max(largest, change.cwiseAbs().maxCoeff());
  }
  return largest;
}

NominalSensitivity nominal_sensitivity(const Study& study, const OperatingPoint& point,
                                       const QpSolverFactory& factory) {
  NominalSensitivity sensitivity{study.cv_count(), point.active, {}};
  for (const ActiveLimit& limit : point.active)
    sensitivity.step_response.push_back(directed_response(study, point, limit, factory));
  return sensitivity;
}

}  // namespace mpm
