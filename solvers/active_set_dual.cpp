#include "solvers/active_set_dual.hpp"

#include <algorithm>
#include <cmath>

#include "base/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

// A limit depends on the working set if its normal leaves less than this of its squared length beside it.
constexpr double kDependent = 1e-12;
constexpr int kRefinements = 6;
constexpr double kRefined = 0.1;  // share of the tolerance

Eigen::Index capacity(const ActiveSetProblem& problem) {
  return problem.variable_count() + (problem.softness.array() > 0.0).count();
}

}  // namespace

DualActiveSet::DualActiveSet(const ActiveSetProblem& problem)
    : problem_(problem),
      geometry_(problem),
      factor_(capacity(problem)),
      linear_(problem.variable_count()),
      z_(problem.variable_count()),
      step_(problem.variable_count()),
      row_value_(problem.structure->row_count()),
      row_slack_(problem.structure->row_count()),
      slack_runs_(slack_runs(*problem.structure)) {
  const Eigen::Index size = capacity(problem);
  working_.reserve(static_cast<std::size_t>(size + 1));
  for (Eigen::VectorXd* vector : {&multiplier_, &products_, &lower_, &direction_})
    vector->setZero(size + 1);
  ray_.setZero(problem.structure->row_count());
  used_.setConstant(std::max(problem.variable_count(), problem.structure->row_count()), 5, false);
}

void DualActiveSet::reset() {
  working_.clear();
  factor_.clear();
  rigid_ = 0;
  used_.setConstant(false);
}

bool& DualActiveSet::in_use(LimitKind kind, Eigen::Index index) {
  return used_(index, static_cast<Eigen::Index>(kind));
}

DualOutcome DualActiveSet::solve(const QpData& data, const Eigen::Ref<const Eigen::VectorXd>& linear,
                                 double tolerance, int& iterations) {
  linear_.vector() = linear;
  const DualOutcome outcome = iterate(data, tolerance, iterations);
  if (outcome != DualOutcome::solved)
    reset();  // the next problem starts from nothing rather than from a failure
  return outcome;
}

DualOutcome DualActiveSet::iterate(const QpData& data, double tolerance, int& iterations) {
  warm_start(data);
  const int limit = iterations + 20 * static_cast<int>(problem_.variable_count() + row_value_.size());
  find_point();
  for (bool refined = false;;) {
    problem_.lanes->multiply_rows(z_.data(), row_value_);
    LimitSide worst;
    if (find_violated(data, tolerance, worst)) {
      if (iterations >= limit)
        return DualOutcome::failed;
      if (const DualOutcome outcome = meet(data, worst, iterations, limit); outcome != DualOutcome::solved)
        return outcome;
      find_point();
      refined = false;
    } else if (refined) {
      return DualOutcome::solved;
    } else {
      refine(data, tolerance);
      refined = true;
    }
  }
}

// Starts with the last working set, as far as it still makes sense: limits that exist and have multipliers of
// the right sign. The multipliers are inv(S) times the amounts by which the limits of the set are exceeded at
// the point without limits.
void DualActiveSet::warm_start(const QpData& data) {
  for (std::size_t k = working_.size(); k-- > 0;)
    if (!std::isfinite(geometry_.limit(data, working_[k])))
      leave(k);
  find_free_point();
  for (std::size_t k = 0; k < working_.size(); ++k)
    products_(static_cast<Eigen::Index>(k)) = excess(data, working_[k]);
  while (!working_.empty()) {
    const auto count = static_cast<Eigen::Index>(working_.size());
    multiplier_.head(count) = products_.head(count);
    factor_.solve_in_place(multiplier_);
    Eigen::Index worst = 0;
    if (multiplier_.head(count).minCoeff(&worst) >= 0.0)
      return;
    leave(static_cast<std::size_t>(worst));
  }
}

// How far the quantity is beyond its limit at z.
double DualActiveSet::excess(const QpData& data, const LimitSide& side) const {
  return side.side * (geometry_.value(side, z_) - geometry_.limit(data, side));
}

// To be called after `meet` has found that `left` of the limit's diagonal in S is independent of the working
// set.
bool DualActiveSet::enter(const LimitSide& side, double multiplier, double left) {
  if (!factor_.append(lower_, left))
    return false;
  multiplier_(static_cast<Eigen::Index>(working_.size())) = multiplier;
  working_.push_back(side);
  rigid_ += geometry_.softness(side) == 0.0;
  in_use(side.kind, side.index) = true;
  return true;
}

void DualActiveSet::leave(std::size_t k) {
  const auto index = static_cast<Eigen::Index>(k);
  in_use(working_[k].kind, working_[k].index) = false;
  rigid_ -= geometry_.softness(working_[k]) == 0.0;
  factor_.remove(index);
  working_.erase(working_.begin() + static_cast<std::ptrdiff_t>(k));
  for (Eigen::Index i = index; i < static_cast<Eigen::Index>(working_.size()); ++i) {
    multiplier_(i) = multiplier_(i + 1);
    products_(i) = products_(i + 1);
  }
}

// One step of iterative refinement of the multipliers, so that z meets every limit of the working set.
// Returns the largest distance to a limit before the step, times the multiplier if that is above 1. The
// change of z is added to z: computed from the multipliers, z would have the rounding error of their size.
double DualActiveSet::equilibrate(const QpData& data) {
  double error = 0.0;
  const auto count = static_cast<Eigen::Index>(working_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const LimitSide& side = working_[static_cast<std::size_t>(i)];
    direction_(i) = excess(data, side) - geometry_.softness(side) * multiplier_(i);
    error = std::max(error, std::abs(direction_(i)) * std::max(1.0, std::abs(multiplier_(i))));
  }
  factor_.solve_in_place(direction_);
  multiplier_.head(count) += direction_.head(count);
  step_.vector().setZero();
  geometry_.subtract_normals(working_, direction_, step_);
  geometry_.apply_inverse(step_);
  z_.vector() += step_.vector();
  return error;
}

void DualActiveSet::refine(const QpData& data, double tolerance) {
  const double scale = std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>());
  for (int k = 0; k < kRefinements; ++k)
    if (equilibrate(data) <= kRefined * tolerance * scale)
      return;
}

// z = -inv(Q) c: the minimiser without limits.
void DualActiveSet::find_free_point() {
  z_.vector() = -linear_.vector();
  geometry_.apply_inverse(z_);
}

// z = -inv(Q) (c + B' multipliers): stationary by construction.
void DualActiveSet::find_point() {
  z_.vector() = -linear_.vector();
  geometry_.subtract_normals(working_, multiplier_, z_);
  geometry_.apply_inverse(z_);
}

// The slack that widens the soft limits of each row; infinite if there is none, as the row has no soft
// limits.
void DualActiveSet::gather_slacks() {
  for (const auto& [first, count, slack] : slack_runs_) {
    const int column = problem_.slack_column(first);
    const double wider = column >= 0 ? z_(column) : slack >= 0 ? 0.0 : kInfinity;
    row_slack_.vector().segment(first, count).setConstant(wider);
  }
}

// Finds the limit outside the working set that is exceeded most, by more than the tolerance. A hard limit of
// a row, which is hardly ever exceeded, counts only if no other limit does.
bool DualActiveSet::find_violated(const QpData& data, double tolerance, LimitSide& worst) {
  double largest = tolerance;
  const auto look = [&](LimitKind kind, Eigen::Index i, double below, double above) {
    const double excess = std::max(below, above);
    if (!(excess > largest) || in_use(kind, i))
      return;
    largest = excess;
    worst = {kind, i, above >= below ? 1.0 : -1.0};
  };
  // The kernel finds the row that is furthest beyond its limits. If its limit is in the working set, all rows
  // are checked.
  const auto look_at_rows = [&](const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                const double* slack, const auto& look_at) {
    double most = largest;
    const Eigen::Index row = lane_kernels().most_violated({.count = row_value_.size(),
                                                           .value = row_value_.data(),
                                                           .lower = lower.data(),
                                                           .upper = upper.data(),
                                                           .dual = nullptr,
                                                           .slack = slack},
                                                          &most);
    if (row < 0)
      return;
    const double before = largest;
    look_at(row);
    for (Eigen::Index i = 0; i < row_value_.size() && largest == before; ++i)
      look_at(i);
  };

  const Eigen::Index n = problem_.structure->variable_count();
  for (Eigen::Index j = 0; j < n; ++j)
    look(LimitKind::bound, j, data.lower(j) - z_(j), z_(j) - data.upper(j));
  for (Eigen::Index j = n; j < z_.size(); ++j)
    look(LimitKind::bound, j, -z_(j), -kInfinity);
  gather_slacks();
  look_at_rows(data.soft_lower, data.soft_upper, row_slack_.data(), [&](Eigen::Index i) {
    const double below = data.soft_lower(i) - row_slack_(i) - row_value_(i);
    const double above = row_value_(i) - row_slack_(i) - data.soft_upper(i);
    if (problem_.slack_column(i) >= 0) {
      look(LimitKind::slack_upper, i, -kInfinity, above);
      look(LimitKind::slack_lower, i, below, -kInfinity);
    } else {
      look(LimitKind::soft, i, below, above);
    }
  });
  if (largest > tolerance)
    return true;
  look_at_rows(data.hard_lower, data.hard_upper, nullptr, [&](Eigen::Index i) {
    look(LimitKind::hard, i, data.hard_lower(i) - row_value_(i), row_value_(i) - data.hard_upper(i));
  });
  return largest > tolerance;
}

void DualActiveSet::find_products(const LimitSide& side) {
  for (std::size_t i = 0; i < working_.size(); ++i)
    products_(static_cast<Eigen::Index>(i)) =
        side.side * working_[i].side * geometry_.product(side, working_[i]);
}

// Raises the multiplier of a violated limit until it is met; limits of the working set whose multiplier falls
// to zero on the way leave.
DualOutcome DualActiveSet::meet(const QpData& data, const LimitSide& side, int& iterations, int limit) {
  double violation = excess(data, side);
  double multiplier = 0.0;
  const double length = geometry_.product(side, side);
  const bool soft = geometry_.softness(side) > 0.0;
  find_products(side);
  while (iterations < limit) {
    ++iterations;
    const auto count = static_cast<Eigen::Index>(working_.size());
    lower_.head(count) = products_.head(count);
    factor_.solve_lower(lower_);
    const double curvature = length - lower_.head(count).squaredNorm();
    direction_.head(count) = lower_.head(count);
    factor_.solve_upper(direction_);

    const bool dependent = curvature <= kDependent * length || rigid_ == problem_.variable_count();
    const double whole = dependent && !soft ? kInfinity : violation / curvature;
    double t = whole;
    std::size_t blocking = working_.size();
    for (Eigen::Index i = 0; i < count; ++i)
      if (direction_(i) > 0.0 && multiplier_(i) < t * direction_(i)) {
        t = std::max(0.0, multiplier_(i) / direction_(i));
        blocking = static_cast<std::size_t>(i);
      }
    if (std::isinf(t)) {
      make_ray(side);
      return DualOutcome::infeasible;
    }
    multiplier_.head(count) -= t * direction_.head(count);
    multiplier += t;
    if (blocking == working_.size())
      return enter(side, multiplier, curvature) ? DualOutcome::solved : DualOutcome::failed;
    if (std::isfinite(whole))
      violation -= t * curvature;
    leave(blocking);
  }
  return DualOutcome::failed;
}

// The normal of `side` is the combination `direction_` of the normals of the working set. The combination is
// refined: to be a proof, it has to be exact where x has no limits.
void DualActiveSet::make_ray(const LimitSide& side) {
  const auto count = static_cast<Eigen::Index>(working_.size());
  for (int k = 0; k < kRefinements; ++k) {
    step_.vector().setZero();
    working_.push_back(side);
    direction_(count) = -1.0;
    geometry_.subtract_normals(working_, direction_, step_);
    working_.pop_back();
    geometry_.apply_inverse(step_);
    for (Eigen::Index i = 0; i < count; ++i) {
      const LimitSide& member = working_[static_cast<std::size_t>(i)];
      products_(i) = member.side * geometry_.value(member, step_);
    }
    factor_.solve_in_place(products_);
    direction_.head(count) += products_.head(count);
  }
  ray_.setZero();
  if (side.kind == LimitKind::hard)
    ray_(side.index) += side.side;
  for (Eigen::Index i = 0; i < count; ++i)
    if (const LimitSide& member = working_[static_cast<std::size_t>(i)]; member.kind == LimitKind::hard)
      ray_(member.index) -= member.side * direction_(i);
}

void DualActiveSet::report(QpResult& result) const {
  const Eigen::Index n = problem_.structure->variable_count();
  result.x = z_.vector().head(n);
  result.slack.setZero();
  result.bound_dual.setZero();
  result.hard_dual.setZero();
  result.soft_dual.setZero();
  for (std::size_t k = 0; k < problem_.kept_slacks.size(); ++k)
    result.slack(problem_.kept_slacks[k]) = std::max(0.0, z_(n + static_cast<Eigen::Index>(k)));
  for (std::size_t i = 0; i < working_.size(); ++i) {
    const auto& [kind, index, side] = working_[i];
    const double force = side * multiplier_(static_cast<Eigen::Index>(i));
    if (kind == LimitKind::bound) {
      if (index < n)
        result.bound_dual(index) = force;
    } else if (kind == LimitKind::hard) {
      result.hard_dual(index) = force;
    } else {
      result.soft_dual(index) += force;
    }
    if (kind == LimitKind::soft)
      result.slack(problem_.structure->slack_of_row(index)) = std::abs(force) / problem_.softness(index);
  }
}

}  // namespace mpm
