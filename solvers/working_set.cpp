#include "solvers/working_set.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

WorkingSet::WorkingSet(const QpStructure& structure)
    : members_(static_cast<std::size_t>(structure.row_count())),
      slack_position_(static_cast<std::size_t>(structure.slack_count()), -1),
      row_value_(structure.row_count()) {}

void WorkingSet::clear() {
  std::fill(members_.begin(), members_.end(), Member{});
  std::fill(slack_position_.begin(), slack_position_.end(), -1);
  rows_.clear();
  slacks_.clear();
}

void WorkingSet::add(int row, RowSide side, int slack) {
  Member& member = members_[static_cast<std::size_t>(row)];
  bool& flag = side == RowSide::hard         ? member.hard
               : side == RowSide::soft_lower ? member.soft_lower
                                             : member.soft_upper;
  if (flag)
    return;
  flag = true;
  rows_.push_back({row, side});
  if (side == RowSide::hard || slack_position_[static_cast<std::size_t>(slack)] >= 0)
    return;
  slack_position_[static_cast<std::size_t>(slack)] = static_cast<int>(slacks_.size());
  slacks_.push_back(slack);
}

void WorkingSet::fill(const QpStructure& structure, const QpData& data) {
  for (int i = 0; i < structure.row_count(); ++i) {
    const int q = structure.slack_of_row(i);
    if (std::isfinite(data.hard_lower(i)) || std::isfinite(data.hard_upper(i)))
      add(i, RowSide::hard, q);
    if (q < 0)
      continue;
    if (std::isfinite(data.soft_lower(i)))
      add(i, RowSide::soft_lower, q);
    if (std::isfinite(data.soft_upper(i)))
      add(i, RowSide::soft_upper, q);
  }
}

void WorkingSet::add_active(const QpStructure& structure, const QpData& data, const QpResult& answer,
                            double tolerance) {
  for (int i = 0; i < structure.row_count(); ++i) {
    const int q = structure.slack_of_row(i);
    if (std::abs(answer.hard_dual(i)) > tolerance)
      add(i, RowSide::hard, q);
    if (answer.soft_dual(i) < -tolerance && std::isfinite(data.soft_lower(i)))
      add(i, RowSide::soft_lower, q);
    if (answer.soft_dual(i) > tolerance && std::isfinite(data.soft_upper(i)))
      add(i, RowSide::soft_upper, q);
  }
}

int WorkingSet::add_violated(const QpStructure& structure, const QpData& data, const Eigen::VectorXd& x,
                             const Eigen::VectorXd& slack, double margin, double tolerance) {
  row_value_.noalias() = structure.rows * x;
  int violated = 0;
  const auto consider = [&](int row, RowSide side, int q, bool member, double excess) {
    if (member || excess < -margin)
      return;
    add(row, side, q);
    if (excess > tolerance)
      ++violated;
  };
  for (int i = 0; i < structure.row_count(); ++i) {
    const Member member = members_[static_cast<std::size_t>(i)];
    const double value = row_value_(i);
    const int q = structure.slack_of_row(i);
    consider(i, RowSide::hard, q, member.hard,
             std::max(data.hard_lower(i) - value, value - data.hard_upper(i)));
    if (q < 0)
      continue;
    consider(i, RowSide::soft_lower, q, member.soft_lower, data.soft_lower(i) - slack(q) - value);
    consider(i, RowSide::soft_upper, q, member.soft_upper, value - data.soft_upper(i) - slack(q));
  }
  return violated;
}

}  // namespace mpm
