#include "solvers/active_set_limits.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "base/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {

LimitGeometry::LimitGeometry(const ActiveSetProblem& problem)
    : problem_(problem),
      lower_(problem.structure->variable_count(), padded(problem.structure->variable_count())),
      inverse_(LaneKernels::kInverse * lower_.stride()),
      packed_(problem.structure->variable_count()),
      scaled_(problem.structure->variable_count(),
              problem.structure->row_count() + problem.structure->variable_count()),
      force_(problem.structure->row_count()) {
  const QpStructure& structure = *problem.structure;
  const Eigen::Index n = structure.variable_count();
  const Eigen::Index m = structure.row_count();
  Eigen::MatrixXd quadratic = structure.hessian;
  quadratic.diagonal() += problem.proximal.head(n);
  const Eigen::MatrixXd factor = quadratic.llt().matrixL();
  LaneVector reciprocal(n);
  std::fill(reciprocal.data(), reciprocal.data() + padded(n), 1.0);
  for (Eigen::Index j = 0; j < n; ++j) {
    reciprocal(j) = 1.0 / factor(j, j);
    std::copy_n(factor.col(j).data() + j + 1, n - 1 - j, lower_.column(j) + j + 1);
  }
  lane_kernels().invert(lower_.data(), lower_.stride(), padded(n), reciprocal.data(), inverse_.data());
  Eigen::MatrixXd columns(n, m + n);
  columns << structure.rows.transpose(), Eigen::MatrixXd::Identity(n, n);
  factor.triangularView<Eigen::Lower>().solveInPlace(columns);
  for (Eigen::Index i = 0; i < m + n; ++i)
    std::copy_n(columns.col(i).data(), n, scaled_.column(i));
  pushing_.reserve(static_cast<std::size_t>(m + problem.variable_count() + 1));
  slack_ = (problem.quadratic.diagonal() + problem.proximal).tail(problem.variable_count() - n);
}

bool LimitGeometry::has_row(const LimitSide& side) const {
  return side.kind != LimitKind::bound || side.index < problem_.structure->variable_count();
}

Eigen::Index LimitGeometry::slack_variable(const LimitSide& side) const {
  const Eigen::Index n = problem_.structure->variable_count();
  switch (side.kind) {
    case LimitKind::bound:
      return side.index >= n ? side.index - n : -1;
    case LimitKind::slack_upper:
    case LimitKind::slack_lower:
      return problem_.slack_column(side.index) - n;
    default:
      return -1;
  }
}

double LimitGeometry::slack_sign(const LimitSide& side) const {
  return side.kind == LimitKind::slack_upper ? -1.0 : 1.0;
}

double LimitGeometry::softness(const LimitSide& side) const {
  return side.kind == LimitKind::soft ? 1.0 / problem_.softness(side.index) : 0.0;
}

double LimitGeometry::product(const LimitSide& first, const LimitSide& second) const {
  const Eigen::Index m = problem_.structure->row_count();
  const auto line = [m](const LimitSide& side) {
    return side.kind == LimitKind::bound ? m + side.index : side.index;
  };
  double sum = 0.0;
  if (has_row(first) && has_row(second))
    sum = lane_kernels().dot(scaled_.column(line(first)), scaled_.column(line(second)), scaled_.stride());
  if (const Eigen::Index q = slack_variable(first); q >= 0 && q == slack_variable(second))
    sum += slack_sign(first) * slack_sign(second) / slack_(q);
  if (first.kind == second.kind && first.index == second.index)
    sum += softness(first);
  return sum;
}

double LimitGeometry::limit(const QpData& data, const LimitSide& side) const {
  const Eigen::Index i = side.index;
  const bool upper = side.side > 0.0;
  switch (side.kind) {
    case LimitKind::bound:
      if (i >= problem_.structure->variable_count())
        return upper ? kInfinity : 0.0;
      return upper ? data.upper(i) : data.lower(i);
    case LimitKind::hard:
      return upper ? data.hard_upper(i) : data.hard_lower(i);
    default:
      return upper ? data.soft_upper(i) : data.soft_lower(i);
  }
}

double LimitGeometry::value(const LimitSide& side, const LaneVector& z) const {
  if (side.kind == LimitKind::bound)
    return z(side.index);
  const Eigen::Index n = problem_.structure->variable_count();
  const double row = problem_.structure->rows.row(side.index).dot(z.vector().head(n));
  const Eigen::Index q = slack_variable(side);
  return q < 0 ? row : row + slack_sign(side) * z(n + q);
}

// The forces on the rows are gathered first: a row may be at more than one of its limits.
void LimitGeometry::subtract_normals(const std::vector<LimitSide>& sides, const Eigen::VectorXd& factor,
                                     LaneVector& vector) {
  const Eigen::Index n = problem_.structure->variable_count();
  pushing_.clear();
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const LimitSide& side = sides[k];
    const double force = -side.side * factor(static_cast<Eigen::Index>(k));
    if (side.kind == LimitKind::bound) {
      vector(side.index) += force;
      continue;
    }
    force_(side.index) += force;
    pushing_.push_back(static_cast<int>(side.index));
    if (const Eigen::Index q = slack_variable(side); q >= 0)
      vector(n + q) += force * slack_sign(side);
  }
  std::sort(pushing_.begin(), pushing_.end());
  pushing_.erase(std::unique(pushing_.begin(), pushing_.end()), pushing_.end());
  problem_.lanes->add_rows(pushing_, force_.data(), vector);
  for (const int i : pushing_)
    force_(i) = 0.0;
}

void LimitGeometry::apply_inverse(LaneVector& vector) {
  const Eigen::Index n = packed_.size();
  packed_.vector() = vector.vector().head(n);
  const LaneKernels& kernels = lane_kernels();
  kernels.solve_lower(lower_.data(), lower_.stride(), padded(n), inverse_.data(), packed_.data());
  kernels.solve_upper(lower_.data(), lower_.stride(), padded(n), inverse_.data(), packed_.data());
  vector.vector().head(n) = packed_.vector();
  vector.vector().tail(slack_.size()).array() /= slack_.array();
}

}  // namespace mpm
