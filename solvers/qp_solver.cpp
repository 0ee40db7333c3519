#include "solvers/qp_solver.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {

QpSolver::QpSolver(std::shared_ptr<const QpStructure> structure) : structure_(std::move(structure)) {
  structure_->validate();
  result_ = QpResult::zero(*structure_);
  workspace_ = std::make_unique<KktWorkspace>(*structure_);
}

const QpResult& QpSolver::solve(const QpData& data) {
  data.validate(*structure_);
  result_.kkt_residual = kInfinity;
  do_solve(data, result_);
  certify(data, result_);
  return result_;
}

void QpSolver::certify(const QpData& data, QpResult& result) {
  result.objective = objective(*structure_, data, result, *workspace_);
  if (result.status == QpStatus::solved && !has_residual_below(kSolvedKktResidual, data, result))
    result.status = QpStatus::numerical_error;
  if (result.status != QpStatus::solved)
    result.kkt_residual = kInfinity;
  result.certified =
      result.status == QpStatus::solved && result.kkt_residual <= largest_certified_residual(result);
}

double QpSolver::largest_certified_residual(const QpResult& result) const {
  if (result.kkt_residual <= kCertifiedKktResidual)
    return kCertifiedKktResidual;
  const double largest =
      std::max(result.x.lpNorm<Eigen::Infinity>(), workspace_->row_value.vector().lpNorm<Eigen::Infinity>());
  return std::max(kCertifiedKktResidual, kAnswerRounding * largest);
}

bool QpSolver::has_residual_below(double limit, const QpData& data, QpResult& result) {
  if (result.kkt_residual <= limit)
    return true;
  const double residual = kkt_residual(*structure_, data, result, *workspace_);
  result.kkt_residual = residual <= limit ? residual : kInfinity;
  return residual <= limit;
}

const QpResult& QpSolver::solve_from(const QpData& data, const Eigen::Ref<const Eigen::VectorXd>& x) {
  if (x.size() != structure_->variable_count())
    throw InputError("guess", fmt::format("{} numbers", x.size()),
                     fmt::format("{}", structure_->variable_count()));
  reset();
  result_.x = x;
  result_.status = QpStatus::solved;
  return solve(data);
}

void QpSolver::reset() {
  result_ = QpResult::zero(*structure_);
  do_reset();
}

QpSolverFactory with_time_limit(QpSolverFactory factory, double seconds) {
  return [factory = std::move(factory), seconds](std::shared_ptr<const QpStructure> structure) {
    std::unique_ptr<QpSolver> solver = factory(std::move(structure));
    solver->set_time_limit(seconds);
    return solver;
  };
}

}  // namespace mpm
