#include "solvers/active_set_curvature.hpp"

#include <algorithm>

namespace mpm {
namespace {

// The weight with which the matrix takes in a spring that it lacks, or gives back one that is released.
double weight_of(const LimitSprings& springs, int row) {
  return springs.stretched(row) ? springs.stiffness(row) : -springs.stiffness(row);
}

}  // namespace

ActiveSetCurvature::ActiveSetCurvature(const ActiveSetProblem& problem, std::size_t family_count)
    : problem_(problem),
      matrix_(problem.variable_count(), padded(problem.variable_count())),
      scratch_(problem.lanes->outer_scratch()) {
  const auto rows = static_cast<std::size_t>(problem.structure->row_count());
  included_.assign(family_count, empty_rows(problem.structure->row_count()));
  changes_.resize(family_count);
  for (std::vector<int>& changes : changes_)
    changes.reserve(rows);
  weights_.resize(rows);
  clear();
}

void ActiveSetCurvature::clear() {
  const Eigen::Index size = problem_.variable_count();
  for (Eigen::Index j = 0; j < matrix_.columns(); ++j) {
    std::fill(matrix_.column(j), matrix_.column(j) + matrix_.stride(), 0.0);
    if (j < size)
      std::copy_n(problem_.quadratic.col(j).data(), size, matrix_.column(j));
    matrix_(j, j) = j < size ? problem_.quadratic(j, j) + problem_.proximal(j) : 1.0;
  }
  for (RowBits& rows : included_)
    std::fill(rows.begin(), rows.end(), static_cast<unsigned char>(0));
}

bool ActiveSetCurvature::synchronise(const std::vector<LimitSprings>& families) {
  const std::size_t changes = find_changes(families);
  if (changes == 0)
    return false;
  if (stretched_ < changes) {
    clear();
    find_changes(families);
  }
  for (std::size_t f = 0; f < families.size(); ++f)
    add(families[f], f);
  return true;
}

std::size_t ActiveSetCurvature::find_changes(const std::vector<LimitSprings>& families) {
  std::size_t count = 0;
  stretched_ = 0;
  for (std::size_t f = 0; f < families.size(); ++f) {
    changes_[f].clear();
    stretched_ += families[f].stretched_rows().size();
    visit_differences(included_[f], families[f].stretched_bits(),
                      [&](int row) { changes_[f].push_back(row); });
    count += changes_[f].size();
  }
  return count;
}

bool ActiveSetCurvature::find_few(const std::vector<LimitSprings>& families,
                                  std::vector<SpringChange>& changes) const {
  changes.clear();
  std::size_t count = 0;
  for (std::size_t f = 0; f < families.size(); ++f)
    count += count_differences(included_[f], families[f].stretched_bits());
  if (count > ActiveSetCorrection::kMost)
    return false;
  for (std::size_t f = 0; f < families.size(); ++f)
    visit_differences(included_[f], families[f].stretched_bits(), [&](int row) {
      changes.push_back({row, families[f].slack_sign, weight_of(families[f], row)});
    });
  return true;
}

void ActiveSetCurvature::add(const LimitSprings& springs, std::size_t family) {
  const std::vector<int>& changes = changes_[family];
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const int i = changes[k];
    weights_[k] = weight_of(springs, i);
    const int column = problem_.slack_column(i);
    if (column < 0 || springs.slack_sign == 0.0)
      continue;
    for (Eigen::Index j = 0; j < problem_.structure->variable_count(); ++j)
      matrix_(column, j) += weights_[k] * springs.slack_sign * problem_.structure->rows(i, j);
    matrix_(column, column) += weights_[k];
  }
  problem_.lanes->add_outer(changes, weights_, scratch_, matrix_);
  included_[family] = springs.stretched_bits();
}

}  // namespace mpm
