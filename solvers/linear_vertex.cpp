#include "solvers/linear_vertex.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace mpm {
namespace {

/// If a multiplier is nearer than this to the end of its range, relative to max(1, |g|), it is open which
/// limits are active.
constexpr double kMargin = 1e-8;
/// If the normals of limits are nearer than this to dependent, their vertex cannot be computed.
constexpr double kDependentNormals = 1e-9;

double margin_of(const QpData& data) {
  return kMargin * std::max(1.0, data.gradient.lpNorm<Eigen::Infinity>());
}

bool within(double value, double lower, double upper) {
  return value >= lower && value <= upper;
}

}  // namespace

bool LinearVertex::applies(const QpStructure& structure) {
  std::vector<int> slacks(structure.slack_of_row.begin(), structure.slack_of_row.end());
  std::erase(slacks, -1);
  std::ranges::sort(slacks);
  return structure.hessian.isZero(0.0) && structure.slack_quadratic.isZero(0.0) &&
         std::ranges::adjacent_find(slacks) == slacks.end();
}

LinearVertex::LinearVertex(const QpStructure& structure)
    : structure_(structure),
      beyond_(Eigen::VectorXi::Zero(structure.row_count())),
      normals_(structure.variable_count(), structure.variable_count()),
      factor_(structure.variable_count()),
      transposed_(structure.variable_count()),
      place_(structure.variable_count()),
      x_(place_),
      cost_(place_),
      multiplier_(place_),
      row_value_(structure.row_count()) {
  active_.reserve(static_cast<std::size_t>(structure.variable_count()) + 1);
  found_.reserve(active_.capacity());
}

void LinearVertex::take(const QpData& data, const QpResult& answer) {
  find_active(answer, margin_of(data));
  if (std::ssize(found_) != structure_.variable_count())
    active_.clear();
  else if (found_ != active_)
    factor();
}

/// Lists at most n + 1 limits: these are enough to know that there is no vertex.
void LinearVertex::find_active(const QpResult& answer, double margin) {
  found_.clear();
  const auto add = [&](Limit limit, Eigen::Index index, double multiplier) {
    if (found_.size() < found_.capacity())
      found_.push_back({limit, index, multiplier > 0.0});
  };
  for (Eigen::Index j = 0; j < answer.bound_dual.size(); ++j)
    if (std::abs(answer.bound_dual(j)) > margin)
      add(Limit::bound, j, answer.bound_dual(j));
  for (Eigen::Index i = 0; i < answer.hard_dual.size(); ++i) {
    if (std::abs(answer.hard_dual(i)) > margin)
      add(Limit::hard, i, answer.hard_dual(i));
    const double soft = answer.soft_dual(i);
    const bool pays = std::abs(soft) > margin;
    const bool pays_all = pays && std::abs(soft) >= price(i) - margin;
    beyond_(i) = pays_all ? (soft > 0.0 ? 1 : -1) : 0;
    if (pays && !pays_all)
      add(Limit::soft, i, soft);
  }
}

void LinearVertex::factor() {
  active_ = found_;
  for (Eigen::Index k = 0; k < normals_.rows(); ++k) {
    const Active& active = active_[static_cast<std::size_t>(k)];
    if (active.limit == Limit::bound) {
      normals_.row(k).setZero();
      normals_(k, active.index) = 1.0;
    } else {
      normals_.row(k) = structure_.rows.row(active.index);
    }
  }
  factor_.compute(normals_);
  transposed_.compute(normals_.transpose());
  const auto pivots = factor_.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > kDependentNormals * pivots.maxCoeff()))
    active_.clear();
}

bool LinearVertex::solve(const QpData& data, QpResult& result) {
  if (active_.empty() || !solve_equations(data) || !multipliers_fit(margin_of(data)) ||
      !limits_are_kept(data))
    return false;
  report(data, result);
  return true;
}

/// Returns false if a limit of the vertex is absent. A value at a limit is set to it exactly, in spite of
/// rounding.
bool LinearVertex::solve_equations(const QpData& data) {
  const auto place = [&](const Active& active) {
    switch (active.limit) {
      case Limit::bound:
        return (active.upper ? data.upper : data.lower)(active.index);
      case Limit::hard:
        return (active.upper ? data.hard_upper : data.hard_lower)(active.index);
      case Limit::soft:
        return (active.upper ? data.soft_upper : data.soft_lower)(active.index);
    }
    return 0.0;
  };
  for (std::size_t k = 0; k < active_.size(); ++k)
    place_(static_cast<Eigen::Index>(k)) = place(active_[k]);
  if (!place_.allFinite())
    return false;
  x_.noalias() = factor_.solve(place_);
  row_value_.noalias() = structure_.rows * x_;
  for (std::size_t k = 0; k < active_.size(); ++k)
    (active_[k].limit == Limit::bound ? x_ : row_value_)(active_[k].index) =
        place_(static_cast<Eigen::Index>(k));
  cost_ = -data.gradient;
  for (Eigen::Index i = 0; i < beyond_.size(); ++i)
    if (beyond_(i) != 0)
      cost_ -= beyond_(i) * price(i) * structure_.rows.row(i).transpose();
  multiplier_.noalias() = transposed_.solve(cost_);
  return true;
}

bool LinearVertex::multipliers_fit(double margin) const {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const double pull = active_[k].upper ? multiplier_(static_cast<Eigen::Index>(k))
                                         : -multiplier_(static_cast<Eigen::Index>(k));
    if (!(pull > margin) || (active_[k].limit == Limit::soft && !(pull < price(active_[k].index) - margin)))
      return false;
  }
  return true;
}

bool LinearVertex::limits_are_kept(const QpData& data) const {
  for (Eigen::Index j = 0; j < x_.size(); ++j)
    if (!within(x_(j), data.lower(j), data.upper(j)))
      return false;
  for (Eigen::Index i = 0; i < row_value_.size(); ++i) {
    const double value = row_value_(i);
    const bool as_before = beyond_(i) > 0   ? value >= data.soft_upper(i)
                           : beyond_(i) < 0 ? value <= data.soft_lower(i)
                                            : within(value, data.soft_lower(i), data.soft_upper(i));
    if (!as_before || !within(value, data.hard_lower(i), data.hard_upper(i)))
      return false;
  }
  return true;
}

void LinearVertex::report(const QpData& data, QpResult& result) const {
  result.status = QpStatus::solved;
  result.x = x_;
  result.bound_dual.setZero();
  result.hard_dual.setZero();
  result.soft_dual.setZero();
  result.slack.setZero();
  for (Eigen::Index i = 0; i < beyond_.size(); ++i)
    if (beyond_(i) != 0) {
      result.soft_dual(i) = beyond_(i) * price(i);
      result.slack(structure_.slack_of_row(i)) =
          std::abs(row_value_(i) - (beyond_(i) > 0 ? data.soft_upper : data.soft_lower)(i));
    }
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const auto& [limit, index, upper] = active_[k];
    Eigen::VectorXd& duals = limit == Limit::bound  ? result.bound_dual
                             : limit == Limit::hard ? result.hard_dual
                                                    : result.soft_dual;
    duals(index) = multiplier_(static_cast<Eigen::Index>(k));
  }
}

}  // namespace mpm
