#include "solvers/active_set_newton.hpp"

#include <algorithm>
#include <cmath>

#include "base/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

// In so many steps, many limits may be met at once. After them, the search stops at the first limit, which is
// slower and finite.
constexpr int kProjectedSteps = 60;
constexpr double kDownhill = 0.3;  // least slope of such a step relative to that of the Newton step
constexpr int kLineSearchSteps = 60;
constexpr double kSlopeLeft = 0.1;  // slope at the end of the line search, relative to its start

}  // namespace

ActiveSetNewton::ActiveSetNewton(const ActiveSetProblem& problem, std::size_t family_count)
    : problem_(problem),
      curvature_(problem, family_count),
      factor_(problem.variable_count()),
      correction_(problem, factor_) {
  const Eigen::Index size = problem.variable_count();
  const Eigen::Index rows = problem.structure->row_count();
  for (LaneVector* vector :
       {&z, &centre, &linear, &lower, &upper, &gradient, &direction_, &step_, &target_, &scratch_})
    *vector = LaneVector(size);
  upper.vector().setConstant(kInfinity);
  for (LaneVector* vector : {&row_value, &row_step_})
    *vector = LaneVector(rows);
  changes_.reserve(ActiveSetCorrection::kMost);
  free_.reserve(static_cast<std::size_t>(size));
  next_free_.reserve(static_cast<std::size_t>(size));
}

void ActiveSetNewton::reset() {
  z.vector().setZero();
  centre.vector().setZero();
  forget_curvature();
}

void ActiveSetNewton::forget_curvature() {
  curvature_.clear();
  correction_.clear();
  factored_ = false;
}

void ActiveSetNewton::start(std::vector<LimitSprings>& families) {
  if (factored_)
    predict(families);
  z.vector() = z.vector().cwiseMax(lower.vector()).cwiseMin(upper.vector());
  problem_.lanes->multiply_rows(z.data(), row_value);
  for (LimitSprings& springs : families)
    if (springs.enabled)
      springs.place(problem_, row_value, z);
}

// Moves z to the minimiser for the present limits, as if the stretched springs and the held variables were
// those of the last call: one solve with the factor that is there. Noise moves all rows of a controlled
// variable together, so that the sets of the last call are a far better guess than the sets that the last z
// has with the present limits.
void ActiveSetNewton::predict(std::vector<LimitSprings>& families) {
  follow_limits();
  for (LimitSprings& springs : families) {
    if (!springs.enabled)
      continue;
    springs.place(problem_, row_value, z);
    springs.pull_stretched();
  }
  find_gradient(families);
  solve_for_direction();
  z.vector() += direction_.vector();
}

// A variable that was held at a limit follows it.
void ActiveSetNewton::follow_limits() {
  std::size_t next = 0;
  bool moved = false;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    if (next < free_.size() && free_[next] == j) {
      ++next;
      continue;
    }
    const double limit = gradient(j) > 0.0 ? lower(j) : upper(j);
    if (std::isfinite(limit) && limit != z(j)) {
      z(j) = limit;
      moved = true;
    }
  }
  if (moved)
    problem_.lanes->multiply_rows(z.data(), row_value);
}

bool ActiveSetNewton::held(Eigen::Index j) const {
  return lower(j) == upper(j) || (z(j) <= lower(j) && gradient(j) >= 0) ||
         (z(j) >= upper(j) && gradient(j) <= 0);
}

double ActiveSetNewton::proximal_force() const {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < z.size(); ++j)
    if (problem_.proximal(j) > 0.0)
      largest = std::max(largest, problem_.proximal(j) * std::abs(z(j) - centre(j)));
  return largest;
}

NewtonOutcome ActiveSetNewton::minimise(std::vector<LimitSprings>& families, double tolerance, int limit,
                                        int& iterations) {
  for (LimitSprings& springs : families)
    if (springs.enabled)
      springs.pull();
  bool same = false;
  for (int round = 0;; ++round) {
    find_gradient(families);
    const double largest = find_free();
    if (largest <= tolerance)
      return NewtonOutcome::converged;
    if (std::isinf(largest))
      return NewtonOutcome::singular;
    if (iterations >= limit)
      return NewtonOutcome::iteration_limit;
    ++iterations;
    if (!find_direction(families, same))
      return NewtonOutcome::singular;
    if (!aim_projected() || round >= kProjectedSteps)
      aim_truncated(families);
    aim_springs(families);

    same = true;
    for (LimitSprings& springs : families)
      if (springs.enabled && springs.find_changing())
        same = false;
    const double t = same ? 1.0 : line_search(families, gradient.vector().dot(step_.vector()));
    if (t == 1.0)
      z.vector() = target_.vector();  // exactly on the limits that are met
    else
      z.vector() = (z.vector() + t * step_.vector()).cwiseMax(lower.vector()).cwiseMin(upper.vector());
    lane_kernels().add_product(row_step_.data(), padded(row_step_.size()), 1, &t, row_value.data());
    for (LimitSprings& springs : families)
      if (springs.enabled)
        springs.advance(t, same);
  }
}

void ActiveSetNewton::find_gradient(const std::vector<LimitSprings>& families) {
  const Eigen::Index n = problem_.structure->variable_count();
  const Eigen::Index kept = z.size() - n;
  gradient.vector() = linear.vector();
  gradient.vector().array() += problem_.proximal.array() * (z.vector() - centre.vector()).array();
  problem_.lanes->add_hessian(z.data(), gradient);
  gradient.vector().tail(kept).array() +=
      problem_.quadratic.diagonal().tail(kept).array() * z.vector().tail(kept).array();
  for (const LimitSprings& springs : families)
    if (springs.enabled)
      add_row_forces(springs);
}

void ActiveSetNewton::add_row_forces(const LimitSprings& springs) {
  problem_.lanes->add_rows(springs.stretched_rows(), springs.force.data(), gradient);
  if (springs.slack_sign == 0.0)
    return;
  for (const int i : springs.stretched_rows())
    if (const int column = problem_.slack_column(i); column >= 0)
      gradient(column) += springs.slack_sign * springs.force(i);
}

// Finds the variables that may move. Returns the largest gradient among them, infinite if one is not a
// number.
double ActiveSetNewton::find_free() {
  next_free_.clear();
  double largest = 0.0;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    if (held(j))
      continue;
    next_free_.push_back(static_cast<int>(j));
    const double size = std::abs(gradient(j));
    largest = std::isnan(size) ? kInfinity : std::max(largest, size);
  }
  return largest;
}

// `anew`: the last step should have ended at the minimiser but did not, so that more digits are needed.
bool ActiveSetNewton::find_direction(const std::vector<LimitSprings>& families, bool anew) {
  if (anew || !factored_ || next_free_ != free_ || !correct_factor(families)) {
    free_.assign(next_free_.begin(), next_free_.end());
    if (!make_factor(families))
      return false;
  }
  solve_for_direction();
  return true;
}

bool ActiveSetNewton::correct_factor(const std::vector<LimitSprings>& families) {
  return curvature_.find_few(families, changes_) && correction_.assign(changes_);
}

bool ActiveSetNewton::make_factor(const std::vector<LimitSprings>& families) {
  curvature_.synchronise(families);
  correction_.clear();
  factored_ = factor_.compute(curvature_.matrix(), free_);
  return factored_;
}

// The Newton step of the free variables; without a factor, a step against the gradient.
void ActiveSetNewton::solve_for_direction() {
  direction_.vector().setZero();
  for (const int j : free_)
    direction_(j) = -gradient(j);
  if (factored_)
    correction_.solve_in_place(direction_);
}

// The step to the point of the box that is nearest to the Newton point. Returns false if it is hardly
// downhill.
bool ActiveSetNewton::aim_projected() {
  step_ = direction_;
  newton_step_ = true;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const double aim = z(j) + direction_(j);
    target_(j) = std::min(std::max(aim, lower(j)), upper(j));
    if (target_(j) != aim) {
      step_(j) = target_(j) - z(j);  // elsewhere the step keeps the digits that z cannot hold
      newton_step_ = false;
    }
  }
  return gradient.vector().dot(step_.vector()) <= kDownhill * gradient.vector().dot(direction_.vector());
}

// The step towards the Newton point up to the first limit.
void ActiveSetNewton::aim_truncated(const std::vector<LimitSprings>& families) {
  newton_step_ = false;
  freeze_blocked(families);
  double longest = 1.0;
  for (const int j : free_)
    if (const double d = direction_(j); d > 0.0)
      longest = std::min(longest, (upper(j) - z(j)) / d);
    else if (d < 0.0)
      longest = std::min(longest, (lower(j) - z(j)) / d);
  step_.vector() = longest * direction_.vector();
  target_.vector() = z.vector() + step_.vector();
  for (const int j : free_)
    if (const double d = direction_(j); d != 0.0 && longest < 1.0) {
      const double limit = d > 0.0 ? upper(j) : lower(j);
      if ((limit - z(j)) / d <= longest)
        target_(j) = limit;
    }
  target_.vector() = target_.vector().cwiseMax(lower.vector()).cwiseMin(upper.vector());
}

// A variable on a limit that the Newton step would push across it is taken out of the step. The gradient
// pulls it inwards, so the others remain downhill.
void ActiveSetNewton::freeze_blocked(const std::vector<LimitSprings>& families) {
  for (bool blocked = true; blocked;) {
    const auto crosses = [this](int j) {
      return (z(j) <= lower(j) && direction_(j) < 0.0) || (z(j) >= upper(j) && direction_(j) > 0.0);
    };
    const auto kept = std::remove_if(free_.begin(), free_.end(), crosses);
    blocked = kept != free_.end();
    if (!blocked)
      return;
    free_.erase(kept, free_.end());
    make_factor(families);
    solve_for_direction();
  }
}

void ActiveSetNewton::aim_springs(std::vector<LimitSprings>& families) {
  problem_.lanes->multiply_rows(step_.data(), row_step_);
  for (LimitSprings& springs : families)
    if (springs.enabled)
      springs.aim(problem_, row_step_, step_);
}

// Second derivative of theta along the step, without the springs that change. Newton's step p solves M p =
// -g, so that p'Mp is minus the slope.
double ActiveSetNewton::steady_curvature(std::vector<LimitSprings>& families, double slope) {
  double result = newton_step_ ? -slope : whole_curvature(families);
  for (const LimitSprings& springs : families)
    if (springs.enabled)
      result -= springs.changing_curvature();
  return std::max(0.0, result);
}

// The same with all springs that are stretched at the start of the step, those that change included.
double ActiveSetNewton::whole_curvature(std::vector<LimitSprings>& families) {
  const Eigen::Index n = problem_.structure->variable_count();
  const Eigen::Index kept = z.size() - n;
  scratch_.vector() = problem_.proximal.cwiseProduct(step_.vector());
  scratch_.vector().tail(kept) +=
      problem_.quadratic.diagonal().tail(kept).cwiseProduct(step_.vector().tail(kept));
  problem_.lanes->add_hessian(step_.data(), scratch_);
  double result = scratch_.vector().dot(step_.vector());
  for (LimitSprings& springs : families)
    if (springs.enabled)
      result += springs.curvature();
  return result;
}

// Finds the root of the derivative of theta along the step, a rising piecewise linear function of t, by
// Newton's method within a bracket. Returns the whole step if theta falls all along it.
double ActiveSetNewton::line_search(std::vector<LimitSprings>& families, double slope) {
  const double steady = steady_curvature(families, slope);
  double low = 0.0;
  double high = 1.0;
  double t = 1.0;
  for (int k = 0; k < kLineSearchSteps; ++k) {
    double first = slope + t * steady;
    double second = steady;
    for (const LimitSprings& springs : families)
      if (springs.enabled)
        springs.add_changing(t, first, second);
    if (first <= 0.0 && (t == 1.0 || first >= kSlopeLeft * slope))
      return t;
    (first > 0.0 ? high : low) = t;
    double next = t - first / second;
    if (!(next > low && next < high))
      next = 0.5 * (low + high);
    if (next == t)
      return t;
    t = next;
  }
  return t;
}

}  // namespace mpm
