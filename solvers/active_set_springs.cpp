#include "solvers/active_set_springs.hpp"

#include <algorithm>

#include "base/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {

LimitSprings::LimitSprings(double sign, const Eigen::VectorXd& k)
    : slack_sign(sign),
      stiffness(k),
      lower(k.size()),
      upper(k.size()),
      multiplier(k.size()),
      force(k.size()),
      value_{nullptr, LaneVector(sign == 0.0 ? 0 : k.size())},
      step_(value_),
      everywhere_((k.array() > 0.0).all()),
      stretched_bits_(empty_rows(k.size())),
      none_(stretched_bits_),
      changing_(static_cast<std::size_t>(padded(k.size()))) {
  lower.vector().setConstant(-kInfinity);
  upper.vector().setConstant(kInfinity);
  stretched_rows_.reserve(changing_.size());
}

SpringArrays LimitSprings::arrays() {
  return {.blocks = padded(size()) / 8,
          .stiffness = stiffness.data(),
          .lower = lower.data(),
          .upper = upper.data(),
          .step = step_.data,
          .value = value_.data,
          .force = force.data(),
          .stretched = stretched_bits_.data()};
}

// A product with numbers that are not finite may leave something behind the last row, which is no spring.
void LimitSprings::list_stretched() {
  if (const Eigen::Index rest = size() % 8; rest != 0)
    stretched_bits_[static_cast<std::size_t>(size() / 8)] &= static_cast<unsigned char>((1U << rest) - 1U);
  stretched_rows_.clear();
  visit_differences(stretched_bits_, none_, [&](int row) { stretched_rows_.push_back(row); });
}

void LimitSprings::assign(Numbers& to, const ActiveSetProblem& problem, const LaneVector& rows,
                          const LaneVector& z) const {
  if (slack_sign == 0.0) {
    to.data = rows.data();
    return;
  }
  to.own = rows;
  to.data = to.own.data();
  for (Eigen::Index i = 0; i < size(); ++i)
    if (const int column = problem.slack_column(i); column >= 0)
      to.own(i) += slack_sign * z(column);
}

void LimitSprings::place(const ActiveSetProblem& problem, const LaneVector& row_value, const LaneVector& z) {
  assign(value_, problem, row_value, z);
}

void LimitSprings::aim(const ActiveSetProblem& problem, const LaneVector& row_step, const LaneVector& p) {
  assign(step_, problem, row_step, p);
}

void LimitSprings::set_limits(const Eigen::VectorXd& row_lower, const Eigen::VectorXd& row_upper) {
  if (everywhere_ && slack_sign == 0.0 && multiplier.vector().lpNorm<Eigen::Infinity>() == 0.0) {
    lower.vector() = row_lower;
    upper.vector() = row_upper;
    return;
  }
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (stiffness(i) == 0.0)
      continue;  // its limits stay infinite
    const double shift = multiplier(i) / stiffness(i);
    if (slack_sign <= 0.0)
      upper(i) = row_upper(i) - shift;
    if (slack_sign >= 0.0)
      lower(i) = row_lower(i) - shift;
  }
}

void LimitSprings::pull() {
  lane_kernels().pull(arrays());
  list_stretched();
}

void LimitSprings::pull_stretched() {
  lane_kernels().pull_stretched(arrays());
  list_stretched();
}

void LimitSprings::release() {
  force.vector().setZero();
  stretched_bits_ = none_;
  stretched_rows_.clear();
}

bool LimitSprings::find_changing() {
  changing_count_ = static_cast<std::size_t>(lane_kernels().find_changing(arrays(), changing_.data()));
  return changing_count_ > 0;
}

void LimitSprings::advance(double t, bool same) {
  if (slack_sign != 0.0)
    value_.own.vector() += t * step_.own.vector();
  if (same)
    lane_kernels().pull_within(arrays());
  else
    lane_kernels().pull(arrays());
  list_stretched();
}

double LimitSprings::curvature() {
  return lane_kernels().curvature(arrays());
}

double LimitSprings::changing_curvature() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < changing_count_; ++k)
    if (const int i = changing_[k]; force(i) != 0.0)
      sum += stiffness(i) * step_.data[i] * step_.data[i];
  return sum;
}

void LimitSprings::add_changing(double t, double& first, double& second) const {
  for (std::size_t k = 0; k < changing_count_; ++k) {
    const int i = changing_[k];
    const double step = step_.data[i];
    const double moved = value_.data[i] + t * step;
    const double stretch = moved - std::min(std::max(moved, lower(i)), upper(i));
    first += step * (stiffness(i) * stretch - force(i));
    second += stretch != 0.0 ? stiffness(i) * step * step : 0.0;
  }
}

}  // namespace mpm
