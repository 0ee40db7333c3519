#include "solvers/active_set_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/active_set_certificate.hpp"
#include "solvers/equilibrated_program.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

// If the least possible largest violation of the hard limits is proven to be above this, the problem has no
// feasible point; below it, the problem is feasible within rounding.
constexpr double kInfeasible = 1e-9;

// Nearly parallel limits divide their force among them only slowly, however stiff they are: after `kPatience`
// rounds, `kAcceptable` times the tolerance is enough.
constexpr int kPatience = 12;
constexpr double kAcceptable = 5.0;
constexpr double kProgress = 0.1;  // share of the residual left by a round; above it, springs are stiffened
constexpr double kStiffer = 16.0;  // a power of two: taking it back is exact
constexpr double kStiffest = 0x1p20;

constexpr double kCertified = 1e-8;  // largest KKT residual of an answer that is accepted

// An error that is small in units of the program's own size may be large in the units of the caller. In the
// program's own units, the tolerance is therefore this share of the caller's.
constexpr double kEquilibratedTolerance = 1e-3;

// Families of springs, in this order; those of kept slacks exist only if there are such slacks.
constexpr std::size_t kSoft = 0, kHard = 1, kSlackUpper = 2;

std::vector<LimitSprings> make_families(const ActiveSetProblem& problem) {
  std::vector<LimitSprings> families;
  families.emplace_back(0.0, problem.softness);
  families.emplace_back(0.0, problem.limit_stiffness);
  if (problem.kept_slacks.empty())
    return families;
  const Eigen::VectorXd kept =
      (problem.slack_column.array() >= 0).select(problem.limit_stiffness, 0.0).matrix();
  families.emplace_back(-1.0, kept);
  families.emplace_back(+1.0, kept);
  return families;
}

QpStatus status_of(NewtonOutcome outcome) {
  return outcome == NewtonOutcome::iteration_limit ? QpStatus::iteration_limit : QpStatus::numerical_error;
}

bool has_answer(const QpResult& result) {
  return result.status == QpStatus::solved || result.status == QpStatus::infeasible;
}

}  // namespace

/// The program in other units, and its solver.
struct ActiveSetSolver::Equilibrated {
  Equilibrated(const QpStructure& structure, ActiveSetOptions options)
      : program(structure), solver(program.structure(), [&] {
          options.equilibrate = false;
          options.tolerance *= kEquilibratedTolerance;
          return options;
        }()) {}

  EquilibratedProgram program;
  ActiveSetSolver solver;
};

void ActiveSetOptions::validate() const {
  if (!(tolerance > 0 && tolerance < 1))
    throw InputError("active-set tolerance", fmt::to_string(tolerance), "0 to 1");
  if (iteration_limit < 1)
    throw InputError("active-set iteration_limit", fmt::to_string(iteration_limit), ">= 1");
  if (round_limit < 1)
    throw InputError("active-set round_limit", fmt::to_string(round_limit), ">= 1");
}

ActiveSetSolver::ActiveSetSolver(std::shared_ptr<const QpStructure> structure,
                                 const ActiveSetOptions& options)
    : QpSolver(std::move(structure)),
      options_(options),
      problem_(this->structure(), lanes()),
      families_(make_families(problem_)),
      newton_(problem_, families_.size()),
      dual_(problem_),
      centre_(problem_.variable_count()),
      dual_linear_(problem_.variable_count()) {
  options_.validate();
  certificate_.setZero(this->structure().row_count());
  change_.setZero(this->structure().row_count());
  scratch_.setZero(this->structure().variable_count());
  if (LinearVertex::applies(this->structure()))
    vertex_.emplace(this->structure());
}

ActiveSetSolver::~ActiveSetSolver() = default;

void ActiveSetSolver::do_reset() {
  reset_newton();
  dual_.reset();
  if (vertex_)
    vertex_->forget();
}

void ActiveSetSolver::reset_newton() {
  newton_.reset();
  for (LimitSprings& springs : families_) {
    springs.multiplier.vector().setZero();
    springs.release();
  }
}

void ActiveSetSolver::do_solve(const QpData& data, QpResult& result) {
  certificate_.setZero();
  // If a problem is at the edge of having no answer, its huge multipliers can hide from the tests of a method
  // that its answer is wrong. Every answer with multipliers is therefore checked as a whole.
  if (vertex_ && vertex_->solve(data, result) && has_residual_below(kCertified, data, result)) {
    result.iterations = 1;
    return;
  }
  search(data, result);
  if (options_.equilibrate && !has_answer(result))
    solve_equilibrated(data, result);
  if (vertex_ && result.status == QpStatus::solved)
    vertex_->take(data, result);
}

void ActiveSetSolver::search(const QpData& data, QpResult& result) {
  result.iterations = 0;
  bind_costs(data);
  // If slacks are shared, few limits are active, and these are nearly parallel: the dual method's case.
  const bool dual_first = !problem_.needs_proximal() && !problem_.kept_slacks.empty();
  if (dual_first && solve_by_dual(data, result))
    return;
  solve_by_newton(data, result);
  if (result.status == QpStatus::solved)
    return;
  reset_newton();  // the next problem starts from nothing rather than from a failure
  if (result.status == QpStatus::infeasible || dual_first)
    return;
  const QpStatus status = result.status;
  if (!solve_by_dual(data, result))
    result.status = status;
}

void ActiveSetSolver::solve_equilibrated(const QpData& data, QpResult& result) {
  if (!equilibrated_)
    equilibrated_ = std::make_unique<Equilibrated>(structure(), options_);
  auto& [program, solver] = *equilibrated_;
  solver.reset();  // the answer must not depend on which problem needed it before
  const QpResult& scaled = solver.solve(program.scaled(data));
  result.iterations += scaled.iterations;
  if (!has_answer(scaled))
    return;
  const QpStatus status = result.status;
  program.write_back(scaled, result);
  program.write_certificate(solver.certificate(), change_);
  const bool stands = result.status == QpStatus::solved ? has_residual_below(kCertified, data, result)
                                                        : proves_infeasible(data, change_);
  if (!stands)
    result.status = status;
}

bool ActiveSetSolver::solve_by_dual(const QpData& data, QpResult& result) {
  const DualOutcome outcome = iterate_dual(data, result.iterations);
  if (outcome == DualOutcome::solved) {
    result.status = QpStatus::solved;
    dual_.report(result);
    return has_residual_below(kCertified, data, result);
  }
  if (outcome == DualOutcome::infeasible && proves_infeasible(data, dual_.ray())) {
    result.status = QpStatus::infeasible;
    return true;
  }
  return false;
}

// If Q is only semidefinite, proximal terms are added, whose centre follows the answer until they vanish.
DualOutcome ActiveSetSolver::iterate_dual(const QpData& data, int& iterations) {
  const double scale = std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>());
  centre_.setZero();
  for (int round = 0; round < options_.round_limit; ++round) {
    dual_linear_ = newton_.linear.vector() - problem_.proximal.cwiseProduct(centre_);
    const DualOutcome outcome = dual_.solve(data, dual_linear_, options_.tolerance, iterations);
    if (outcome != DualOutcome::solved || !problem_.needs_proximal())
      return outcome;
    centre_ -= dual_.point().vector();
    if (problem_.proximal.cwiseProduct(centre_).lpNorm<Eigen::Infinity>() <= options_.tolerance * scale)
      return outcome;
    centre_ = dual_.point().vector();
  }
  return DualOutcome::failed;
}

void ActiveSetSolver::solve_by_newton(const QpData& data, QpResult& result) {
  bind_limits(data);
  newton_.start(families_);
  result.status = iterate(data, result.iterations);
  report(result);
  const bool multipliers = families_[kHard].enabled || !problem_.kept_slacks.empty();
  if (result.status == QpStatus::solved && multipliers && !has_residual_below(kCertified, data, result))
    result.status = QpStatus::numerical_error;
}

void ActiveSetSolver::bind_costs(const QpData& data) {
  const Eigen::Index n = structure().variable_count();
  newton_.linear.vector().head(n) = data.gradient;
  for (std::size_t k = 0; k < problem_.kept_slacks.size(); ++k)
    newton_.linear(n + static_cast<Eigen::Index>(k)) = structure().slack_linear(problem_.kept_slacks[k]);
}

void ActiveSetSolver::bind_limits(const QpData& data) {
  const Eigen::Index n = structure().variable_count();
  newton_.lower.vector().head(n) = data.lower;
  newton_.upper.vector().head(n) = data.upper;
  newton_.centre.vector().setZero();
  if (stiffening_ != 1.0)
    stiffen(1.0 / stiffening_);
  // Hard limits are seldom active: they are enabled if the warm start has one, or when the answer breaks one.
  LimitSprings& hard = families_[kHard];
  hard.enabled = hard.multiplier.vector().lpNorm<Eigen::Infinity>() > 0.0;
  if (!hard.enabled)
    hard.release();
  set_limits(data);
}

void ActiveSetSolver::set_limits(const QpData& data) {
  for (std::size_t f = 0; f < families_.size(); ++f)
    if (!families_[f].enabled)
      continue;
    else if (f == kHard)
      families_[f].set_limits(data.hard_lower, data.hard_upper);
    else
      families_[f].set_limits(data.soft_lower, data.soft_upper);
}

QpStatus ActiveSetSolver::iterate(const QpData& data, int& iterations) {
  const double scale = std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>());
  LimitSprings& hard = families_[kHard];
  double last_residual = kInfinity;
  for (int round = 0; round < options_.round_limit; ++round) {
    const NewtonOutcome outcome =
        newton_.minimise(families_, options_.tolerance * scale, options_.iteration_limit, iterations);
    if (outcome != NewtonOutcome::converged)
      return status_of(outcome);
    if (!hard.enabled && !hard_limits_kept(data)) {
      hard.enabled = true;
      set_limits(data);
      hard.place(problem_, newton_.row_value, newton_.z);
      continue;
    }
    const double residual = update_multipliers(scale);
    if (residual > (round < kPatience ? 1.0 : kAcceptable) * options_.tolerance) {
      if (hard.enabled && proves_infeasible(data, change_))
        return QpStatus::infeasible;
      if (residual > kProgress * last_residual)
        stiffen(kStiffer);
      last_residual = residual;
      set_limits(data);
      continue;
    }
    if (newton_.proximal_force() <= options_.tolerance * scale)
      return QpStatus::solved;
    newton_.centre.vector() = newton_.z.vector();
  }
  return QpStatus::iteration_limit;
}

// Stiffer springs need fewer rounds of multipliers.
void ActiveSetSolver::stiffen(double factor) {
  if (stiffening_ * factor > kStiffest)
    return;
  stiffening_ = factor * stiffening_;
  for (std::size_t f = kHard; f < families_.size(); ++f)
    families_[f].stiffness.vector() *= factor;
  newton_.forget_curvature();
}

bool ActiveSetSolver::hard_limits_kept(const QpData& data) const {
  return lane_kernels().violation({.count = structure().row_count(),
                                   .value = newton_.row_value.data(),
                                   .lower = data.hard_lower.data(),
                                   .upper = data.hard_upper.data(),
                                   .dual = nullptr,
                                   .slack = nullptr}) <= options_.tolerance;
}

// One round of the method of multipliers: the forces become the multipliers. Returns the distance from a
// solution: the largest violation of a limit, or force times distance to its limit relative to `scale`.
double ActiveSetSolver::update_multipliers(double scale) {
  double residual = 0.0;
  if (families_[kHard].enabled)
    change_ = families_[kHard].force.vector() - families_[kHard].multiplier.vector();
  for (std::size_t f = kHard; f < families_.size(); ++f) {
    LimitSprings& springs = families_[f];
    if (!springs.enabled)
      continue;
    for (Eigen::Index i = 0; i < springs.size(); ++i) {
      const double force = springs.force(i);
      const double change = force - springs.multiplier(i);
      if (change == 0.0)
        continue;
      const double distance = std::abs(change / springs.stiffness(i));
      residual = std::max({residual, distance, std::abs(force) * distance / scale});
      springs.multiplier(i) = force;
    }
  }
  return residual;
}

// The multipliers of an infeasible problem grow without end, in a direction that proves it. A component that
// shrinks, at a row without an opposite limit, does not belong to that direction.
bool ActiveSetSolver::proves_infeasible(const QpData& data, const Eigen::VectorXd& y) {
  certificate_ = y;
  for (Eigen::Index i = 0; i < certificate_.size(); ++i)
    if (std::isinf(y(i) > 0.0 ? data.hard_upper(i) : data.hard_lower(i)))
      certificate_(i) = 0.0;
  if (!(proven_violation(structure(), data, certificate_, scratch_) > kInfeasible)) {
    certificate_.setZero();
    return false;
  }
  certificate_ /= certificate_.lpNorm<1>();
  return true;
}

void ActiveSetSolver::report(QpResult& result) const {
  const Eigen::Index n = structure().variable_count();
  result.x = newton_.z.vector().head(n);
  for (Eigen::Index j = 0; j < n; ++j)
    result.bound_dual(j) = newton_.held(j) ? -newton_.gradient(j) : 0.0;
  result.hard_dual = families_[kHard].force.vector();
  result.soft_dual = families_[kSoft].force.vector();
  for (std::size_t f = kSlackUpper; f < families_.size(); ++f)
    result.soft_dual += families_[f].force.vector();

  result.slack.setZero();
  for (std::size_t k = 0; k < problem_.kept_slacks.size(); ++k)
    result.slack(problem_.kept_slacks[k]) = newton_.z(n + static_cast<Eigen::Index>(k));
  for (const int i : families_[kSoft].stretched_rows())
    result.slack(structure().slack_of_row(i)) = std::abs(families_[kSoft].force(i)) / problem_.softness(i);
}

}  // namespace mpm
