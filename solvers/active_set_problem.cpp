#include "solvers/active_set_problem.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "solvers/active_set_factor.hpp"

namespace mpm {
namespace {

// H counts as positive definite when its smallest eigenvalue is above this share of its largest diagonal.
constexpr double kDefinite = 1e-9;
// Proximal weight relative to the curvature scale. It is small, so that the proximal iteration takes few
// rounds.
constexpr double kProximal = 1e-6;
// Stiffness |a_i|^2 rho_i of a limit relative to the curvature scale. It is large, so that few rounds of
// multipliers are needed, but no larger: rho times the rounding error of a row value is the error of the
// forces.
constexpr double kStiffness = 0.1;

bool is_definite(const Eigen::MatrixXd& hessian) {
  if (hessian.rows() == 0)
    return true;
  const double shift = kDefinite * hessian.diagonal().cwiseAbs().maxCoeff();
  LaneMatrix shifted(hessian.rows(), padded(hessian.rows()));
  for (Eigen::Index j = 0; j < shifted.columns(); ++j) {
    if (j < hessian.rows())
      std::copy_n(hessian.col(j).data(), hessian.rows(), shifted.column(j));
    shifted(j, j) = j < hessian.rows() ? hessian(j, j) - shift : 1.0;
  }
  std::vector<int> all(static_cast<std::size_t>(hessian.rows()));
  std::iota(all.begin(), all.end(), 0);
  return ActiveSetFactor(hessian.rows()).compute(shifted, all);
}

/// How many rows share each slack.
std::vector<int> slack_users(const QpStructure& structure) {
  std::vector<int> users(static_cast<std::size_t>(structure.slack_count()), 0);
  for (const int q : structure.slack_of_row)
    if (q >= 0)
      ++users[static_cast<std::size_t>(q)];
  return users;
}

}  // namespace

ActiveSetProblem::ActiveSetProblem(const QpStructure& qp)
    : ActiveSetProblem(qp, std::make_shared<const LaneProgram>(qp.hessian, qp.rows)) {}

ActiveSetProblem::ActiveSetProblem(const QpStructure& qp, std::shared_ptr<const LaneProgram> shared)
    : structure(&qp), lanes(std::move(shared)) {
  const Eigen::Index n = qp.variable_count();
  const std::vector<int> users = slack_users(qp);
  std::vector<int> column(users.size(), -1);
  for (std::size_t q = 0; q < users.size(); ++q) {
    const auto index = static_cast<Eigen::Index>(q);
    if (users[q] == 0 || (users[q] == 1 && qp.slack_linear(index) == 0.0))
      continue;
    column[q] = static_cast<int>(n) + static_cast<int>(kept_slacks.size());
    kept_slacks.push_back(static_cast<int>(q));
  }

  const auto kept = static_cast<Eigen::Index>(kept_slacks.size());
  quadratic.setZero(n + kept, n + kept);
  quadratic.topLeftCorner(n, n) = qp.hessian;
  proximal.setZero(n + kept);
  double linear_scale = 0.0;
  for (Eigen::Index k = 0; k < kept; ++k) {
    const int q = kept_slacks[static_cast<std::size_t>(k)];
    quadratic(n + k, n + k) = 2.0 * qp.slack_quadratic(q);
    if (qp.slack_quadratic(q) == 0.0) {
      proximal(n + k) = 1.0;
      linear_scale = std::max(linear_scale, qp.slack_linear(q));
    }
  }
  if (!is_definite(qp.hessian) || qp.hessian.isZero(0.0))
    proximal.head(n).setOnes();

  slack_column.setConstant(qp.row_count(), -1);
  softness.setZero(qp.row_count());
  Eigen::VectorXd curvature = quadratic.diagonal();
  for (Eigen::Index i = 0; i < qp.row_count(); ++i) {
    const int q = qp.slack_of_row(i);
    if (q < 0)
      continue;
    slack_column(i) = column[static_cast<std::size_t>(q)];
    if (slack_column(i) >= 0)
      continue;
    softness(i) = 2.0 * qp.slack_quadratic(q);
    curvature.head(n) += softness(i) * qp.rows.row(i).transpose().cwiseAbs2();
  }

  double scale = std::max(linear_scale, curvature.size() > 0 ? curvature.maxCoeff() : 0.0);
  if (scale <= 0.0)
    scale = 1.0;
  proximal *= kProximal * scale;
  limit_stiffness.resize(qp.row_count());
  for (Eigen::Index i = 0; i < qp.row_count(); ++i) {
    const double length = qp.rows.row(i).squaredNorm() + (slack_column(i) >= 0 ? 1.0 : 0.0);
    limit_stiffness(i) = kStiffness * scale / (length > 0.0 ? length : 1.0);
  }
}

void ActiveSetProblem::write_normal(int row, double slack_sign, LaneVector& normal) const {
  const Eigen::Index n = structure->variable_count();
  normal.vector().head(n) = structure->rows.row(row).transpose();
  normal.vector().tail(variable_count() - n).setZero();
  if (const int column = slack_column(row); column >= 0)
    normal(column) = slack_sign;
}

}  // namespace mpm
