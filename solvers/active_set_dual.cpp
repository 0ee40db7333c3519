#include "solvers/active_set_dual.hpp"

#include <algorithm>
#include <cmath>

#include "plants/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

// A limit whose normal leaves less than this of its squared length beside the working set depends on it.
constexpr double kDependent = 1e-12;
constexpr int kRefinements = 6;
constexpr double kRefined = 0.1;  // of the tolerance

Eigen::Index capacity(const ActiveSetProblem& problem) {
  return problem.variable_count() + (problem.softness.array() > 0.0).count();
}

}  // namespace

DualActiveSet::DualActiveSet(const ActiveSetProblem& problem)
    : problem_(problem), geometry_(problem), factor_(capacity(problem)) {
  const Eigen::Index size = capacity(problem);
  working_.reserve(static_cast<std::size_t>(size));
  candidates_.reserve(static_cast<std::size_t>(size));
  for (Eigen::VectorXd* vector : {&multiplier_, &products_, &direction_})
    vector->setZero(size + 1);
  linear_.setZero(problem.variable_count());
  z_.setZero(problem.variable_count());
  step_.setZero(problem.variable_count());
  row_value_ = LaneVector(problem.structure->row_count());
  ray_.setZero(problem.structure->row_count());
  used_.setConstant(std::max(problem.variable_count(), problem.structure->row_count()), 5, false);
}

bool& DualActiveSet::in_use(const LimitSide& side) {
  return used_(side.index, static_cast<Eigen::Index>(side.kind));
}

DualOutcome DualActiveSet::solve(const QpData& data, const Eigen::Ref<const Eigen::VectorXd>& linear,
                                 double tolerance, int& iterations) {
  linear_ = linear;
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

// The last working set where it still makes sense: limits that exist, do not depend on each other and have
// multipliers of the right sign.
void DualActiveSet::warm_start(const QpData& data) {
  candidates_.assign(working_.begin(), working_.end());
  working_.clear();
  factor_.clear();
  rigid_ = 0;
  used_.setConstant(false);
  for (const LimitSide& side : candidates_)
    if (std::isfinite(geometry_.limit(data, side))) {
      find_products(side);
      enter(side, 0.0);
    }
  for (;;) {
    find_point();
    equilibrate(data);
    const auto count = static_cast<Eigen::Index>(working_.size());
    Eigen::Index worst = 0;
    if (count == 0 || multiplier_.head(count).minCoeff(&worst) >= 0.0)
      return;
    leave(static_cast<std::size_t>(worst));
  }
}

// With `products_` of the limit.
bool DualActiveSet::enter(const LimitSide& side, double multiplier) {
  const auto count = static_cast<Eigen::Index>(working_.size());
  if (!factor_.append(products_.head(count), geometry_.product(side, side), kDependent))
    return false;
  multiplier_(count) = multiplier;
  working_.push_back(side);
  rigid_ += geometry_.softness(side) == 0.0;
  in_use(side) = true;
  return true;
}

void DualActiveSet::leave(std::size_t k) {
  const auto index = static_cast<Eigen::Index>(k);
  in_use(working_[k]) = false;
  rigid_ -= geometry_.softness(working_[k]) == 0.0;
  factor_.remove(index);
  working_.erase(working_.begin() + static_cast<std::ptrdiff_t>(k));
  for (Eigen::Index i = index; i < static_cast<Eigen::Index>(working_.size()); ++i)
    multiplier_(i) = multiplier_(i + 1);
}

// One step of iterative refinement of the multipliers with which every limit of the working set is met.
// Returns the largest distance to a limit, times its multiplier when above 1, before the step. The change of
// z is added to it: z as computed from the multipliers has the rounding error of their size.
double DualActiveSet::equilibrate(const QpData& data) {
  double error = 0.0;
  const auto count = static_cast<Eigen::Index>(working_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const LimitSide& side = working_[static_cast<std::size_t>(i)];
    direction_(i) = side.side * (geometry_.value(side, z_) - geometry_.limit(data, side)) -
                    geometry_.softness(side) * multiplier_(i);
    error = std::max(error, std::abs(direction_(i)) * std::max(1.0, std::abs(multiplier_(i))));
  }
  factor_.solve_in_place(direction_);
  multiplier_.head(count) += direction_.head(count);
  step_.setZero();
  for (Eigen::Index i = 0; i < count; ++i) {
    const LimitSide& side = working_[static_cast<std::size_t>(i)];
    geometry_.add_normal(side, -side.side * direction_(i), step_);
  }
  geometry_.apply_inverse(step_);
  z_ += step_;
  return error;
}

void DualActiveSet::refine(const QpData& data, double tolerance) {
  const double scale = std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>());
  for (int k = 0; k < kRefinements; ++k)
    if (equilibrate(data) <= kRefined * tolerance * scale)
      return;
}

// z = -inv(Q) (c + B' multipliers): stationary by construction.
void DualActiveSet::find_point() {
  z_ = -linear_;
  for (std::size_t i = 0; i < working_.size(); ++i)
    geometry_.add_normal(working_[i], -working_[i].side * multiplier_(static_cast<Eigen::Index>(i)), z_);
  geometry_.apply_inverse(z_);
}

bool DualActiveSet::find_violated(const QpData& data, double tolerance, LimitSide& worst) const {
  const Eigen::Index n = problem_.structure->variable_count();
  double largest = tolerance;
  const auto look = [&](LimitKind kind, Eigen::Index i, double below, double above) {
    const double excess = std::max(below, above);
    if (!(excess > largest) || used_(i, static_cast<Eigen::Index>(kind)))
      return;
    largest = excess;
    worst = {kind, i, above >= below ? 1.0 : -1.0};
  };
  for (Eigen::Index j = 0; j < n; ++j)
    look(LimitKind::bound, j, data.lower(j) - z_(j), z_(j) - data.upper(j));
  for (Eigen::Index j = n; j < z_.size(); ++j)
    look(LimitKind::bound, j, -z_(j), -kInfinity);
  const double hard = lane_kernels().violation({.count = row_value_.size(),
                                                .value = row_value_.data(),
                                                .lower = data.hard_lower.data(),
                                                .upper = data.hard_upper.data(),
                                                .dual = nullptr,
                                                .slack = nullptr});
  for (Eigen::Index i = 0; i < row_value_.size() && hard > largest; ++i)
    look(LimitKind::hard, i, data.hard_lower(i) - row_value_(i), row_value_(i) - data.hard_upper(i));
  for (Eigen::Index i = 0; i < row_value_.size(); ++i) {
    const int column = problem_.slack_column(i);
    const double slack = column >= 0 ? z_(column) : 0.0;
    const double above = row_value_(i) - slack - data.soft_upper(i);
    const double below = data.soft_lower(i) - row_value_(i) - slack;
    if (!(above > largest || below > largest))
      continue;
    if (column >= 0) {
      look(LimitKind::slack_upper, i, -kInfinity, above);
      look(LimitKind::slack_lower, i, below, -kInfinity);
    } else if (problem_.softness(i) > 0.0) {
      look(LimitKind::soft, i, below, above);
    }
  }
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
  double violation = side.side * (geometry_.value(side, z_) - geometry_.limit(data, side));
  double multiplier = 0.0;
  const double length = geometry_.product(side, side);
  const bool soft = geometry_.softness(side) > 0.0;
  while (iterations < limit) {
    ++iterations;
    find_products(side);
    const auto count = static_cast<Eigen::Index>(working_.size());
    direction_.head(count) = products_.head(count);
    factor_.solve_in_place(direction_);
    const double curvature = length - products_.head(count).dot(direction_.head(count));

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
      return enter(side, multiplier) ? DualOutcome::solved : DualOutcome::failed;
    if (std::isfinite(whole))
      violation -= t * curvature;
    leave(blocking);
  }
  return DualOutcome::failed;
}

// The normal of `side` is the combination `direction_` of those of the working set. The combination is
// refined: as a proof it has to be exact where x has no limits.
void DualActiveSet::make_ray(const LimitSide& side) {
  const auto count = static_cast<Eigen::Index>(working_.size());
  for (int k = 0; k < kRefinements; ++k) {
    step_.setZero();
    geometry_.add_normal(side, side.side, step_);
    for (Eigen::Index i = 0; i < count; ++i)
      geometry_.add_normal(working_[static_cast<std::size_t>(i)],
                           -working_[static_cast<std::size_t>(i)].side * direction_(i), step_);
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
  result.x = z_.head(n);
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
