#include "tests/solvers/qp_builder.hpp"

#include "base/non_finite.hpp"

namespace mpm::samples {
namespace {

template <typename Vector, typename Number>
void append(Vector& vector, Number number) {
  vector.conservativeResize(vector.size() + 1);
  vector(vector.size() - 1) = number;
}

}  // namespace

QpBuilder::QpBuilder(std::string name, Eigen::MatrixXd hessian, const Eigen::VectorXd& gradient) {
  const Eigen::Index n = gradient.size();
  qp_.name = std::move(name);
  structure_.hessian = std::move(hessian);
  structure_.rows.resize(0, n);
  qp_.data = QpData::unconstrained(structure_);
  qp_.data.gradient = gradient;
}

QpBuilder& QpBuilder::box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  qp_.data.lower = lower;
  qp_.data.upper = upper;
  return *this;
}

QpBuilder& QpBuilder::slack(double quadratic, double linear) {
  append(structure_.slack_quadratic, quadratic);
  append(structure_.slack_linear, linear);
  return *this;
}

void QpBuilder::add_row(const Eigen::VectorXd& row, int q) {
  structure_.rows.conservativeResize(structure_.rows.rows() + 1, Eigen::NoChange);
  structure_.rows.bottomRows(1) = row.transpose();
  append(structure_.slack_of_row, q);
  append(qp_.data.hard_lower, -kInfinity);
  append(qp_.data.hard_upper, kInfinity);
  append(qp_.data.soft_lower, -kInfinity);
  append(qp_.data.soft_upper, kInfinity);
}

QpBuilder& QpBuilder::hard(const Eigen::VectorXd& row, double lower, double upper) {
  add_row(row, -1);
  return also_hard(lower, upper);
}

QpBuilder& QpBuilder::soft(const Eigen::VectorXd& row, int q, double lower, double upper) {
  add_row(row, q);
  qp_.data.soft_lower.tail(1).setConstant(lower);
  qp_.data.soft_upper.tail(1).setConstant(upper);
  return *this;
}

QpBuilder& QpBuilder::also_hard(double lower, double upper) {
  qp_.data.hard_lower.tail(1).setConstant(lower);
  qp_.data.hard_upper.tail(1).setConstant(upper);
  return *this;
}

QpBuilder& QpBuilder::answer(const Eigen::VectorXd& x) {
  qp_.x = x;
  return *this;
}

QpBuilder& QpBuilder::not_unique() {
  qp_.unique = false;
  return *this;
}

QpBuilder& QpBuilder::infeasible() {
  qp_.expected = QpStatus::infeasible;
  return *this;
}

NamedQp QpBuilder::build() const {
  NamedQp qp = qp_;
  qp.structure = std::make_shared<const QpStructure>(structure_);
  return qp;
}

}  // namespace mpm::samples
