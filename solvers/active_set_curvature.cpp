#include "solvers/active_set_curvature.hpp"

#include <algorithm>

namespace mpm {
namespace {

constexpr std::size_t kTogether = 4;  // rank-one terms added in one pass over the matrix

}  // namespace

ActiveSetCurvature::ActiveSetCurvature(const ActiveSetProblem& problem, std::size_t family_count)
    : problem_(problem), matrix_(problem.variable_count(), problem.variable_count()) {
  const auto rows = static_cast<std::size_t>(problem.structure->row_count());
  included_.assign(family_count, std::vector<unsigned char>(rows, 0));
  touched_.assign(family_count, false);
  changes_.reserve(family_count * rows);
  pending_.reserve(kTogether);
  clear();
}

void ActiveSetCurvature::clear() {
  matrix_ = problem_.quadratic;
  matrix_.diagonal() += problem_.proximal;
  for (std::vector<unsigned char>& flags : included_)
    std::fill(flags.begin(), flags.end(), static_cast<unsigned char>(0));
  std::fill(touched_.begin(), touched_.end(), false);
}

bool ActiveSetCurvature::synchronise(const std::vector<LimitSprings>& families) {
  find_changes(families);
  if (changes_.empty())
    return false;
  if (stretched_ < changes_.size()) {
    clear();
    find_changes(families);
  }
  for (const Change& change : changes_) {
    const LimitSprings& springs = families[change.family];
    const bool now = springs.stretched(change.row);
    add(springs, change.row, now ? springs.stiffness(change.row) : -springs.stiffness(change.row));
    included_[change.family][static_cast<std::size_t>(change.row)] = now;
  }
  flush();
  return true;
}

void ActiveSetCurvature::find_changes(const std::vector<LimitSprings>& families) {
  changes_.clear();
  stretched_ = 0;
  for (std::size_t f = 0; f < families.size(); ++f) {
    if (!families[f].enabled && !touched_[f])
      continue;
    touched_[f] = true;
    for (Eigen::Index i = 0; i < families[f].size(); ++i) {
      const bool now = families[f].stretched(i);
      stretched_ += now;
      if (now != (included_[f][static_cast<std::size_t>(i)] != 0))
        changes_.push_back({f, i});
    }
  }
}

void ActiveSetCurvature::add(const LimitSprings& springs, Eigen::Index i, double weight) {
  const auto row = problem_.structure->rows.row(i);
  if (const int column = problem_.slack_column(i); column >= 0 && springs.slack_sign != 0.0) {
    matrix_.row(column).head(row.size()) += weight * springs.slack_sign * row;
    matrix_(column, column) += weight;
  }
  pending_.push_back({row.data(), weight});
  if (pending_.size() == kTogether)
    flush();
}

void ActiveSetCurvature::flush() {
  if (pending_.empty())
    return;
  while (pending_.size() < kTogether)
    pending_.push_back({pending_.front().row, 0.0});
  const Eigen::Index n = problem_.structure->variable_count();
  const auto [a0, w0] = pending_[0];
  const auto [a1, w1] = pending_[1];
  const auto [a2, w2] = pending_[2];
  const auto [a3, w3] = pending_[3];
  for (Eigen::Index j = 0; j < n; ++j) {
    const double c0 = w0 * a0[j];
    const double c1 = w1 * a1[j];
    const double c2 = w2 * a2[j];
    const double c3 = w3 * a3[j];
    double* column = matrix_.col(j).data();
    for (Eigen::Index i = j; i < n; ++i)
      column[i] += c0 * a0[i] + c1 * a1[i] + c2 * a2[i] + c3 * a3[i];
  }
  pending_.clear();
}

}  // namespace mpm
