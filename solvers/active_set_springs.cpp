#include "solvers/active_set_springs.hpp"

#include <algorithm>
#include <utility>

#include "plants/non_finite.hpp"

namespace mpm {

LimitSprings::LimitSprings(double sign, Eigen::VectorXd k) : slack_sign(sign), stiffness(std::move(k)) {
  const double infinity = kInfinity;
  lower.setConstant(size(), -infinity);
  upper.setConstant(size(), infinity);
  multiplier.setZero(size());
  value.setZero(size());
  step.setZero(size());
  force.setZero(size());
  changing_.reserve(static_cast<std::size_t>(size()));
}

void LimitSprings::assign(Eigen::VectorXd& to, const ActiveSetProblem& problem, const Eigen::VectorXd& rows,
                          const Eigen::VectorXd& z) const {
  to = rows;
  if (slack_sign == 0.0)
    return;
  for (Eigen::Index i = 0; i < size(); ++i)
    if (const int column = problem.slack_column(i); column >= 0)
      to(i) += slack_sign * z(column);
}

void LimitSprings::place(const ActiveSetProblem& problem, const Eigen::VectorXd& row_value,
                         const Eigen::VectorXd& z) {
  assign(value, problem, row_value, z);
}

void LimitSprings::aim(const ActiveSetProblem& problem, const Eigen::VectorXd& row_step,
                       const Eigen::VectorXd& p) {
  assign(step, problem, row_step, p);
}

void LimitSprings::set_limits(const Eigen::VectorXd& row_lower, const Eigen::VectorXd& row_upper) {
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (stiffness(i) == 0.0)
      continue;  // its limits stay infinite
    const double shift = multiplier(i) / stiffness(i);
    if (slack_sign <= 0.0)
      upper(i) = row_upper(i) - shift;
    if (slack_sign >= 0.0)
      lower(i) = row_lower(i) - shift;
  }
}

void LimitSprings::pull() {
  force = stiffness.array() * (value.array() - value.array().max(lower.array()).min(upper.array()));
}

void LimitSprings::pull_stretched() {
  for (Eigen::Index i = 0; i < size(); ++i)
    if (force(i) != 0.0)
      force(i) = stiffness(i) * (value(i) - (force(i) > 0.0 ? upper(i) : lower(i)));
}

bool LimitSprings::find_changing() {
  changing_.clear();
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double moved = value(i) + step(i);
    // A spring that goes from one end to the other changes, too.
    if ((moved > upper(i)) != (force(i) > 0.0) || (moved < lower(i)) != (force(i) < 0.0))
      changing_.push_back(i);
  }
  return !changing_.empty();
}

void LimitSprings::advance(double t, bool same) {
  if (same) {
    for (Eigen::Index i = 0; i < size(); ++i)
      force(i) = force(i) != 0.0 ? force(i) + stiffness(i) * step(i) : 0.0;
    value += step;
    return;
  }
  value += t * step;
  pull();
}

double LimitSprings::steady_curvature() const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size(); ++i)
    sum += force(i) != 0.0 ? stiffness(i) * step(i) * step(i) : 0.0;
  for (const Eigen::Index i : changing_)
    sum -= force(i) != 0.0 ? stiffness(i) * step(i) * step(i) : 0.0;
  return std::max(0.0, sum);
}

void LimitSprings::add_changing(double t, double& first, double& second) const {
  for (const Eigen::Index i : changing_) {
    const double moved = value(i) + t * step(i);
    const double stretch = moved - std::min(std::max(moved, lower(i)), upper(i));
    first += step(i) * (stiffness(i) * stretch - force(i));
    second += stretch != 0.0 ? stiffness(i) * step(i) * step(i) : 0.0;
  }
}

}  // namespace mpm
