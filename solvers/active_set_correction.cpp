#include "solvers/active_set_correction.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

// The share of a diagonal of inv(D) + W'W that must be left after elimination. If less is left, too many
// digits are lost for a step of Newton's method that should end at the minimiser.
constexpr double kSmallestLeft = 1e-6;

}  // namespace

ActiveSetCorrection::ActiveSetCorrection(const ActiveSetProblem& problem, ActiveSetFactor& factor)
    : problem_(problem),
      factor_(factor),
      w_(problem.variable_count(), kMost),
      gram_(Small::Zero()),
      lower_(Small::Zero()),
      normal_(problem.variable_count()),
      packed_(problem.variable_count()) {
  changes_.reserve(kMost);
}

void ActiveSetCorrection::clear() {
  changes_.clear();
}

bool ActiveSetCorrection::assign(const std::vector<SpringChange>& changes) {
  if (changes == changes_)
    return true;
  if (changes.size() <= kMost) {
    keep(changes);
    for (const SpringChange& change : changes)
      if (std::find(changes_.begin(), changes_.end(), change) == changes_.end())
        add(change);
    if (factor_small())
      return true;
  }
  clear();
  return false;
}

// Keeps those of the present changes that are listed; the last change takes the place of each that goes.
void ActiveSetCorrection::keep(const std::vector<SpringChange>& changes) {
  for (std::size_t k = changes_.size(); k-- > 0;) {
    if (std::find(changes.begin(), changes.end(), changes_[k]) != changes.end())
      continue;
    const auto to = static_cast<Eigen::Index>(k);
    const auto last = static_cast<Eigen::Index>(changes_.size()) - 1;
    std::copy_n(w_.column(last), w_.stride(), w_.column(to));
    for (Eigen::Index j = 0; j < last; ++j)
      (j <= to ? gram_(to, j) : gram_(j, to)) = gram_(last, j);
    gram_(to, to) = gram_(last, last);
    changes_[k] = changes_.back();
    changes_.pop_back();
  }
}

void ActiveSetCorrection::add(const SpringChange& change) {
  const auto k = static_cast<Eigen::Index>(changes_.size());
  problem_.write_normal(change.row, change.slack_sign, normal_);
  factor_.pack(normal_, w_.column(k));
  factor_.solve_lower(w_.column(k));
  for (Eigen::Index j = 0; j <= k; ++j)
    gram_(k, j) = lane_kernels().dot(w_.column(j), w_.column(k), factor_.packed_size());
  changes_.push_back(change);
}

// inv(D) + W'W is quasidefinite: if M_FF + B D B' is positive definite, every pivot has the sign of its
// weight, in any order.
bool ActiveSetCorrection::factor_small() {
  const auto count = static_cast<Eigen::Index>(changes_.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    const double inverse = 1.0 / changes_[static_cast<std::size_t>(k)].weight;
    double pivot = inverse + gram_(k, k);
    double left[kMost];  // row k of L D, where inv(D) + W'W = L D L'
    for (Eigen::Index j = 0; j < k; ++j) {
      left[j] = gram_(k, j);
      for (Eigen::Index i = 0; i < j; ++i)
        left[j] -= left[i] * lower_(j, i);
      lower_(k, j) = left[j] * lower_(j, j);
      pivot -= left[j] * lower_(k, j);
    }
    const double size = std::abs(inverse) + gram_(k, k);
    if (!(pivot * inverse > 0.0 && std::abs(pivot) > kSmallestLeft * size))
      return false;
    lower_(k, k) = 1.0 / pivot;
  }
  return true;
}

void ActiveSetCorrection::solve_small(double* b) const {
  const auto count = static_cast<Eigen::Index>(changes_.size());
  for (Eigen::Index k = 0; k < count; ++k)
    for (Eigen::Index j = 0; j < k; ++j)
      b[k] -= lower_(k, j) * b[j];
  for (Eigen::Index k = count - 1; k >= 0; --k) {
    b[k] *= lower_(k, k);
    for (Eigen::Index j = k + 1; j < count; ++j)
      b[k] -= lower_(j, k) * b[j];
  }
}

void ActiveSetCorrection::solve_in_place(LaneVector& vector) {
  const auto count = static_cast<Eigen::Index>(changes_.size());
  double* x = packed_.data();
  factor_.pack(vector, x);
  factor_.solve_lower(x);
  if (count > 0) {
    double push[kMost];
    for (Eigen::Index k = 0; k < count; ++k)
      push[k] = -lane_kernels().dot(w_.column(k), x, factor_.packed_size());
    solve_small(push);
    lane_kernels().add_product(w_.data(), w_.stride(), count, push, x);
  }
  factor_.solve_upper(x);
  factor_.unpack(x, vector);
}

}  // namespace mpm
