#include "solvers/reduced_program.hpp"

#include <algorithm>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Tells which rows have a slack that can be eliminated with its limit.
std::vector<bool> rows_with_own_slack(const QpStructure& structure) {
  std::vector<int> users(static_cast<std::size_t>(structure.slack_count()), 0);
  for (const int q : structure.slack_of_row)
    if (q >= 0)
      ++users[static_cast<std::size_t>(q)];
  std::vector<bool> own(static_cast<std::size_t>(structure.row_count()), false);
  for (Eigen::Index i = 0; i < structure.row_count(); ++i)
    if (const int q = structure.slack_of_row(i); q >= 0)
      own[static_cast<std::size_t>(i)] = users[static_cast<std::size_t>(q)] == 1 &&
                                         structure.slack_linear(q) == 0.0 &&
                                         structure.slack_quadratic(q) > 0.0;
  return own;
}

/// +1 where the slack is a x - limit + p, -1 where it is limit - a x + p.
double sign_of(RowSide side) {
  return side == RowSide::soft_upper ? 1.0 : -1.0;
}

double soft_limit(WorkingRow row, const QpData& data) {
  return row.side == RowSide::soft_upper ? data.soft_upper(row.row) : data.soft_lower(row.row);
}

}  // namespace

ReducedProgram::ReducedProgram(const QpStructure& structure)
    : structure_(structure), own_slack_(rows_with_own_slack(structure)) {}

bool ReducedProgram::has_surplus(WorkingRow row) const {
  return row.side != RowSide::hard && own_slack_[static_cast<std::size_t>(row.row)];
}

void ReducedProgram::number_unknowns(const WorkingSet& set) {
  int columns = static_cast<int>(structure_.variable_count());
  int constraint_count = 0;
  slack_column_.assign(set.slacks().size(), -1);
  column_.assign(set.rows().size(), -1);
  for (std::size_t r = 0; r < set.rows().size(); ++r) {
    const WorkingRow row = set.rows()[r];
    if (has_surplus(row)) {
      column_[r] = columns++;
      continue;
    }
    ++constraint_count;
    if (row.side == RowSide::hard)
      continue;
    int& column =
        slack_column_[static_cast<std::size_t>(set.slack_position(structure_.slack_of_row(row.row)))];
    if (column < 0)
      column = columns++;
  }
  gradient_.setZero(columns);
  lower_.setZero(columns);  // for surpluses and slacks; the limits of x follow
  upper_.setConstant(columns, kInfinity);
  start_.setZero(columns);
  constraint_lower_.setConstant(constraint_count, -kInfinity);
  constraint_upper_.setConstant(constraint_count, kInfinity);
}

void ReducedProgram::assemble(const WorkingSet& set, const QpData& data, const QpResult& start) {
  const Eigen::Index n = structure_.variable_count();
  number_unknowns(set);
  hessian_.clear();
  constraints_.clear();
  hessian_of_x_ = structure_.hessian;
  gradient_.head(n) = data.gradient;
  lower_.head(n) = data.lower;
  upper_.head(n) = data.upper;
  start_.head(n) = start.x;

  int constraint = 0;
  for (std::size_t r = 0; r < set.rows().size(); ++r)
    if (column_[r] >= 0)
      add_surplus(set.rows()[r], column_[r], data);
    else
      add_constraint(set.rows()[r], constraint++, set, data);
  for (std::size_t k = 0; k < slack_column_.size(); ++k)
    if (const int column = slack_column_[k]; column >= 0) {
      const int q = set.slacks()[k];
      gradient_(column) = structure_.slack_linear(q);
      start_(column) = start.slack(q);
      hessian_.push_back({column, column, 2.0 * structure_.slack_quadratic(q)});
    }
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i)
      hessian_.push_back({i, j, hessian_of_x_(i, j)});
}

// w s^2 with s = sign (a x - limit) + p.
void ReducedProgram::add_surplus(WorkingRow row, int column, const QpData& data) {
  const double stiffness = 2.0 * structure_.slack_quadratic(structure_.slack_of_row(row.row));
  const double sign = sign_of(row.side);
  const double limit = soft_limit(row, data);
  const auto a = structure_.rows.row(row.row).transpose();
  hessian_of_x_.selfadjointView<Eigen::Lower>().rankUpdate(a, stiffness);
  gradient_.head(a.size()) -= stiffness * limit * a;
  gradient_(column) = -stiffness * sign * limit;
  for (int i = 0; i < a.size(); ++i)
    hessian_.push_back({column, i, stiffness * sign * a(i)});
  hessian_.push_back({column, column, stiffness});
  start_(column) = std::max(0.0, sign * (limit - a.dot(start_.head(a.size()))));
}

void ReducedProgram::add_constraint(WorkingRow row, int constraint, const WorkingSet& set,
                                    const QpData& data) {
  for (int i = 0; i < structure_.variable_count(); ++i)
    constraints_.push_back({constraint, i, structure_.rows(row.row, i)});
  if (row.side == RowSide::hard) {
    constraint_lower_(constraint) = data.hard_lower(row.row);
    constraint_upper_(constraint) = data.hard_upper(row.row);
    return;
  }
  const auto position = static_cast<std::size_t>(set.slack_position(structure_.slack_of_row(row.row)));
  constraints_.push_back({constraint, slack_column_[position], -sign_of(row.side)});
  (row.side == RowSide::soft_upper ? constraint_upper_ : constraint_lower_)(constraint) =
      soft_limit(row, data);
}

void ReducedProgram::report(const WorkingSet& set, const QpData& data,
                            const Eigen::Ref<const Eigen::VectorXd>& z,
                            const Eigen::Ref<const Eigen::VectorXd>& bound_dual,
                            const Eigen::Ref<const Eigen::VectorXd>& constraint_dual,
                            QpResult& result) const {
  const Eigen::Index n = structure_.variable_count();
  result.x = z.head(n);
  result.bound_dual = bound_dual.head(n);
  result.slack.setZero();
  result.hard_dual.setZero();
  result.soft_dual.setZero();
  Eigen::Index constraint = 0;
  for (std::size_t r = 0; r < set.rows().size(); ++r) {
    const WorkingRow row = set.rows()[r];
    if (column_[r] < 0) {
      (row.side == RowSide::hard ? result.hard_dual : result.soft_dual)(row.row) +=
          constraint_dual(constraint++);
      continue;
    }
    const int q = structure_.slack_of_row(row.row);
    const double sign = sign_of(row.side);
    const double slack = std::max(
        0.0, sign * (structure_.rows.row(row.row).dot(result.x) - soft_limit(row, data)) + z(column_[r]));
    result.slack(q) = std::max(result.slack(q), slack);
    result.soft_dual(row.row) += sign * 2.0 * structure_.slack_quadratic(q) * slack;
  }
  for (std::size_t k = 0; k < slack_column_.size(); ++k)
    if (slack_column_[k] >= 0)
      result.slack(set.slacks()[k]) = z(slack_column_[k]);
}

}  // namespace mpm
