#include "solvers/qp.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

void require_size(const char* name, Eigen::Index found, Eigen::Index expected) {
  if (found != expected)
    throw InputError(name, fmt::format("{} elements", found), fmt::format("{}", expected));
}

void require_ordered(const char* name, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  for (Eigen::Index i = 0; i < lower.size(); ++i)
    if (!(lower(i) <= upper(i) && lower(i) < kInfinity && upper(i) > -kInfinity))  // also false for NaN
      throw InputError(fmt::format("{}[{}]", name, i),
                       fmt::format("lower {} and upper {}", lower(i), upper(i)),
                       "lower <= upper, no NaN, an absent limit is -inf below and inf above");
}

// A multiplier belongs to its upper limit when positive and to its lower one when negative. Its part of the
// complementarity is |multiplier| times the distance to that limit; at an absent limit nothing may push.
double complementarity(double dual, double value, double lower, double upper) {
  if (dual == 0.0)
    return 0.0;
  const double limit = dual > 0.0 ? upper : lower;
  return std::isinf(limit) ? std::abs(dual) : std::abs(dual * (limit - value));
}

bool all_finite(const QpResult& result) {
  return result.x.allFinite() && result.slack.allFinite() && result.bound_dual.allFinite() &&
         result.hard_dual.allFinite() && result.soft_dual.allFinite();
}

double violation(double value, double lower, double upper) {
  return std::max({0.0, lower - value, value - upper});
}

}  // namespace

void QpStructure::validate() const {
  const Eigen::Index n = variable_count();
  require_size("QP hessian (columns)", hessian.cols(), n);
  require_size("QP slack_of_row", slack_of_row.size(), row_count());
  require_size("QP slack_linear", slack_linear.size(), slack_count());
  require_size("QP rows (columns)", rows.cols(), n);
  if (!hessian.allFinite() || !rows.allFinite())
    throw InputError("QP hessian and rows", "a number that is not finite", "finite numbers");
  if (n > 0 &&
      (hessian - hessian.transpose()).cwiseAbs().maxCoeff() > 1e-12 * (1 + hessian.cwiseAbs().maxCoeff()))
    throw InputError("QP hessian", "an unsymmetric matrix", "a symmetric one");
  for (Eigen::Index q = 0; q < slack_count(); ++q)
    if (!(slack_quadratic(q) >= 0 && slack_linear(q) >= 0 && slack_quadratic(q) + slack_linear(q) > 0 &&
          slack_quadratic(q) + slack_linear(q) < kInfinity))
      throw InputError(fmt::format("QP slack weights[{}]", q),
                       fmt::format("{} and {}", slack_quadratic(q), slack_linear(q)),
                       "both finite, >= 0 and not both zero");
  for (Eigen::Index i = 0; i < row_count(); ++i)
    if (slack_of_row(i) < -1 || slack_of_row(i) >= slack_count())
      throw InputError(fmt::format("QP slack_of_row[{}]", i), fmt::format("{}", slack_of_row(i)),
                       fmt::format("-1 to {}", slack_count() - 1));
}

QpData QpData::unconstrained(const QpStructure& structure) {
  const Eigen::Index n = structure.variable_count();
  const Eigen::Index m = structure.row_count();
  const auto below = [](Eigen::Index size) { return Eigen::VectorXd::Constant(size, -kInfinity).eval(); };
  const auto above = [](Eigen::Index size) { return Eigen::VectorXd::Constant(size, kInfinity).eval(); };
  return {Eigen::VectorXd::Zero(n), below(n), above(n), below(m), above(m), below(m), above(m)};
}

void QpData::validate(const QpStructure& structure) const {
  const Eigen::Index n = structure.variable_count();
  const Eigen::Index m = structure.row_count();
  require_size("QP gradient", gradient.size(), n);
  require_size("QP lower", lower.size(), n);
  require_size("QP upper", upper.size(), n);
  require_size("QP hard_lower", hard_lower.size(), m);
  require_size("QP hard_upper", hard_upper.size(), m);
  require_size("QP soft_lower", soft_lower.size(), m);
  require_size("QP soft_upper", soft_upper.size(), m);
  if (!gradient.allFinite())
    throw InputError("QP gradient", "a number that is not finite", "finite numbers");
  require_ordered("QP limits of x", lower, upper);
  require_ordered("QP hard limits", hard_lower, hard_upper);
  require_ordered("QP soft limits", soft_lower, soft_upper);
}

std::string_view to_string(QpStatus status) {
  switch (status) {
    case QpStatus::solved:
      return "solved";
    case QpStatus::infeasible:
      return "infeasible";
    case QpStatus::iteration_limit:
      return "iteration limit";
    case QpStatus::numerical_error:
      return "numerical error";
  }
  return "unknown";
}

QpResult QpResult::zero(const QpStructure& structure) {
  QpResult result;
  result.x.setZero(structure.variable_count());
  result.slack.setZero(structure.slack_count());
  result.bound_dual.setZero(structure.variable_count());
  result.hard_dual.setZero(structure.row_count());
  result.soft_dual.setZero(structure.row_count());
  return result;
}

double objective(const QpStructure& structure, const QpData& data, const QpResult& result) {
  double value = 0.0;
  for (Eigen::Index i = 0; i < structure.variable_count(); ++i)
    value += result.x(i) * (0.5 * structure.hessian.col(i).dot(result.x) + data.gradient(i));
  for (Eigen::Index q = 0; q < structure.slack_count(); ++q)
    value += result.slack(q) * (structure.slack_quadratic(q) * result.slack(q) + structure.slack_linear(q));
  return value;
}

KktWorkspace::KktWorkspace(const QpStructure& structure)
    : row_dual(structure.row_count()),
      row_value(structure.row_count()),
      stationarity(structure.variable_count()),
      slack_force(structure.slack_count()) {}

double kkt_residual(const QpStructure& structure, const QpData& data, const QpResult& result) {
  KktWorkspace workspace(structure);
  return kkt_residual(structure, data, result, workspace);
}

double kkt_residual(const QpStructure& structure, const QpData& data, const QpResult& result,
                    KktWorkspace& workspace) {
  if (!all_finite(result))  // comparisons below would let NaN pass
    return kInfinity;
  const Eigen::VectorXd& x = result.x;
  auto& [row_dual, row_value, stationarity, slack_force] = workspace;
  row_dual = result.hard_dual + result.soft_dual;
  row_value.noalias() = structure.rows * x;

  stationarity = data.gradient + result.bound_dual;
  stationarity.noalias() += structure.hessian * x;
  for (Eigen::Index i = 0; i < row_dual.size(); ++i)  // most rows do not push
    if (row_dual(i) != 0.0)
      stationarity += row_dual(i) * structure.rows.row(i).transpose();
  const double scale = std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>());

  double scaled = stationarity.lpNorm<Eigen::Infinity>();
  double absolute = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    absolute = std::max(absolute, violation(x(i), data.lower(i), data.upper(i)));
    scaled = std::max(scaled, complementarity(result.bound_dual(i), x(i), data.lower(i), data.upper(i)));
  }

  slack_force = structure.slack_linear;
  slack_force.array() += 2.0 * structure.slack_quadratic.array() * result.slack.array();
  for (Eigen::Index i = 0; i < row_value.size(); ++i) {
    const int q = structure.slack_of_row(i);
    const double s = q < 0 ? 0.0 : result.slack(q);
    absolute = std::max(absolute, violation(row_value(i), data.hard_lower(i), data.hard_upper(i)));
    scaled = std::max(
        scaled, complementarity(result.hard_dual(i), row_value(i), data.hard_lower(i), data.hard_upper(i)));
    if (q < 0)
      continue;
    absolute = std::max(absolute, violation(row_value(i), data.soft_lower(i) - s, data.soft_upper(i) + s));
    scaled = std::max(scaled, complementarity(result.soft_dual(i), row_value(i), data.soft_lower(i) - s,
                                              data.soft_upper(i) + s));
    slack_force(q) -= std::abs(result.soft_dual(i));
  }
  for (Eigen::Index q = 0; q < slack_force.size(); ++q) {
    absolute = std::max(absolute, -result.slack(q));
    // What is left of the force is the multiplier of s >= 0: not negative, and zero where s > 0.
    scaled = std::max({scaled, -slack_force(q), std::abs(slack_force(q) * result.slack(q))});
  }
  return std::max(absolute, scaled / scale);
}

}  // namespace mpm
