#include "solvers/qp.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

void require_size(const char* name, Eigen::Index found, Eigen::Index expected) {
  if (found != expected)
    throw InputError(name, fmt::format("{} elements", found), fmt::format("{}", expected));
}

void require_ordered(const char* name, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  if (lane_kernels().ordered(lower.data(), upper.data(), lower.size()))
    return;
  for (Eigen::Index i = 0; i < lower.size(); ++i)
    if (!(lower(i) <= upper(i) && lower(i) < kInfinity && upper(i) > -kInfinity))  // also false for NaN
      throw InputError(fmt::format("{}[{}]", name, i),
                       fmt::format("lower {} and upper {}", lower(i), upper(i)),
                       "lower <= upper, no NaN, an absent limit is -inf below and inf above");
}

bool all_finite(const QpResult& result) {
  const auto finite = [](const Eigen::VectorXd& numbers) {
    return lane_kernels().finite(numbers.data(), numbers.size());
  };
  return finite(result.x) && finite(result.slack) && finite(result.bound_dual) && finite(result.hard_dual) &&
         finite(result.soft_dual);
}

bool has_own_slacks(const QpStructure& structure) {
  Eigen::Index i = 0;
  while (i < structure.row_count() && structure.slack_of_row(i) == i)
    ++i;
  return i == structure.row_count() && i == structure.slack_count();
}

SlackArrays slack_arrays(const QpStructure& structure, const QpResult& result, const double* pull) {
  return {.count = structure.slack_count(),
          .slack = result.slack.data(),
          .quadratic = structure.slack_quadratic.data(),
          .linear = structure.slack_linear.data(),
          .pull = pull};
}

// A row without a slack has no soft limits.
void gather_slacks(const QpResult& result, KktWorkspace& w) {
  w.pull.setZero();
  for (const auto& [first, count, q] : w.runs) {
    w.row_slack.segment(first, count).setConstant(q < 0 ? kInfinity : result.slack(q));
    if (q >= 0)
      w.pull(q) += result.soft_dual.segment(first, count).lpNorm<1>();
  }
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
    case QpStatus::time_limit:
      return "time limit";
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

std::vector<SlackRun> slack_runs(const QpStructure& structure) {
  std::vector<SlackRun> runs;
  for (Eigen::Index i = 0; i < structure.row_count(); ++i)
    if (runs.empty() || runs.back().slack != structure.slack_of_row(i))
      runs.push_back({i, 1, structure.slack_of_row(i)});
    else
      ++runs.back().count;
  return runs;
}

double objective(const QpStructure& structure, const QpData& data, const QpResult& result) {
  KktWorkspace workspace(structure);
  return objective(structure, data, result, workspace);
}

double objective(const QpStructure& structure, const QpData& data, const QpResult& result,
                 KktWorkspace& workspace) {
  LaneVector& curved = workspace.stationarity;
  curved.vector().setZero();
  workspace.lanes->add_hessian(result.x.data(), curved);
  double value = 0.0;
  for (Eigen::Index i = 0; i < structure.variable_count(); ++i)
    value += result.x(i) * (0.5 * curved(i) + data.gradient(i));
  return value + lane_kernels().slack_cost(slack_arrays(structure, result, nullptr));
}

KktWorkspace::KktWorkspace(const QpStructure& structure)
    : lanes(std::make_shared<const LaneProgram>(structure.hessian, structure.rows)),
      own_slacks(has_own_slacks(structure)),
      runs(own_slacks ? std::vector<SlackRun>{} : slack_runs(structure)),
      row_value(structure.row_count()),
      row_dual(structure.row_count()),
      row_slack(own_slacks ? 0 : structure.row_count()),
      pull(own_slacks ? 0 : structure.slack_count()),
      stationarity(structure.variable_count()) {
  pushing.reserve(static_cast<std::size_t>(structure.row_count()));
}

double kkt_residual(const QpStructure& structure, const QpData& data, const QpResult& result) {
  KktWorkspace workspace(structure);
  return kkt_residual(structure, data, result, workspace);
}

double kkt_residual(const QpStructure& structure, const QpData& data, const QpResult& result,
                    KktWorkspace& workspace) {
  if (!all_finite(result))  // comparisons below would let NaN pass
    return kInfinity;
  const LaneKernels& kernels = lane_kernels();
  KktWorkspace& w = workspace;
  w.lanes->multiply_rows(result.x.data(), w.row_value);
  if (!w.own_slacks)
    gather_slacks(result, w);
  w.stationarity.vector() = data.gradient + result.bound_dual;
  w.lanes->add_hessian(result.x.data(), w.stationarity);
  w.row_dual = result.hard_dual + result.soft_dual;
  w.pushing.resize(static_cast<std::size_t>(w.row_dual.size()));
  const long pushing = kernels.non_zero(w.row_dual.data(), w.row_dual.size(), w.pushing.data());
  w.pushing.resize(static_cast<std::size_t>(pushing));
  w.lanes->add_rows(w.pushing, w.row_dual.data(), w.stationarity);

  const auto slack_pull = w.own_slacks ? result.soft_dual.data() : w.pull.data();
  double scaled = std::max(w.stationarity.vector().lpNorm<Eigen::Infinity>(),
                           kernels.slack_residual(slack_arrays(structure, result, slack_pull)));
  double absolute = kernels.below_zero(result.slack.data(), result.slack.size());
  const auto look = [&](const double* value, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                        const Eigen::VectorXd& dual, const double* slack) {
    const LimitArrays limits{dual.size(), value, lower.data(), upper.data(), dual.data(), slack};
    absolute = std::max(absolute, kernels.violation(limits));
    scaled = std::max(scaled, kernels.complementarity(limits));
  };
  look(result.x.data(), data.lower, data.upper, result.bound_dual, nullptr);
  look(w.row_value.data(), data.hard_lower, data.hard_upper, result.hard_dual, nullptr);
  look(w.row_value.data(), data.soft_lower, data.soft_upper, result.soft_dual,
       w.own_slacks ? result.slack.data() : w.row_slack.data());
  return std::max(absolute, scaled / std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>()));
}

}  // namespace mpm
