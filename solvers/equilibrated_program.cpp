#include "solvers/equilibrated_program.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

/// The power of two nearest to 1 / size; 1 for a size of 0.
double inverse_power(double size) {
  return size > 0.0 ? std::exp2(-std::round(std::log2(size))) : 1.0;
}

Eigen::VectorXd variable_units(const QpStructure& qp) {
  Eigen::VectorXd units(qp.variable_count());
  for (Eigen::Index j = 0; j < units.size(); ++j) {
    const double largest = qp.row_count() > 0 ? qp.rows.col(j).cwiseAbs().maxCoeff() : 0.0;
    units(j) = inverse_power(qp.hessian(j, j) > 0.0 ? std::sqrt(qp.hessian(j, j)) : largest);
  }
  return units;
}

/// Length of each row in the units of the variables; for rows that share a slack, that of the longest of
/// them.
Eigen::VectorXd row_lengths(const QpStructure& qp, const Eigen::VectorXd& units) {
  Eigen::VectorXd lengths = (qp.rows * units.asDiagonal()).rowwise().norm();
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(qp.slack_count());
  for (Eigen::Index i = 0; i < lengths.size(); ++i)
    if (const int q = qp.slack_of_row(i); q >= 0)
      longest(q) = std::max(longest(q), lengths(i));
  for (Eigen::Index i = 0; i < lengths.size(); ++i)
    if (const int q = qp.slack_of_row(i); q >= 0)
      lengths(i) = longest(q);
  return lengths;
}

}  // namespace

EquilibratedProgram::EquilibratedProgram(const QpStructure& qp)
    : variable_(variable_units(qp)),
      row_(row_lengths(qp, variable_).unaryExpr(&inverse_power)),
      slack_(Eigen::VectorXd::Ones(qp.slack_count())),
      data_(QpData::unconstrained(qp)) {
  for (Eigen::Index i = 0; i < qp.row_count(); ++i)
    if (qp.slack_of_row(i) >= 0)
      slack_(qp.slack_of_row(i)) = row_(i);
  structure_ = std::make_shared<const QpStructure>(QpStructure{
      .hessian = variable_.asDiagonal() * qp.hessian * variable_.asDiagonal(),
      .rows = row_.asDiagonal() * qp.rows * variable_.asDiagonal(),
      .slack_of_row = qp.slack_of_row,
      .slack_quadratic = qp.slack_quadratic.cwiseQuotient(slack_.cwiseAbs2()),
      .slack_linear = qp.slack_linear.cwiseQuotient(slack_),
  });
}

const QpData& EquilibratedProgram::scaled(const QpData& data) {
  data_.gradient = data.gradient.cwiseProduct(variable_);
  data_.lower = data.lower.cwiseQuotient(variable_);
  data_.upper = data.upper.cwiseQuotient(variable_);
  data_.hard_lower = data.hard_lower.cwiseProduct(row_);
  data_.hard_upper = data.hard_upper.cwiseProduct(row_);
  data_.soft_lower = data.soft_lower.cwiseProduct(row_);
  data_.soft_upper = data.soft_upper.cwiseProduct(row_);
  return data_;
}

void EquilibratedProgram::write_back(const QpResult& scaled, QpResult& result) const {
  result.status = scaled.status;
  result.x = scaled.x.cwiseProduct(variable_);
  result.slack = scaled.slack.cwiseQuotient(slack_);
  result.bound_dual = scaled.bound_dual.cwiseQuotient(variable_);
  result.hard_dual = scaled.hard_dual.cwiseProduct(row_);
  result.soft_dual = scaled.soft_dual.cwiseProduct(row_);
}

void EquilibratedProgram::write_certificate(const Eigen::VectorXd& scaled,
                                            Eigen::VectorXd& certificate) const {
  certificate = scaled.cwiseProduct(row_);
}

}  // namespace mpm
