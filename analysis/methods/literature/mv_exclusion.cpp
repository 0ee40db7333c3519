#include "analysis/methods/literature/mv_exclusion.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/sensitivity/active_limit.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

void require_limits(const Eigen::Ref<const Eigen::MatrixXd>& u, const MvLimits& limits) {
  if (limits.lower.size() != u.rows() || limits.upper.size() != u.rows())
    throw InputError("limits of the MVs",
                     fmt::format("{} lower and {} upper ones", limits.lower.size(), limits.upper.size()),
                     fmt::format("{} of each", u.rows()));
  for (Eigen::Index i = 0; i < u.rows(); ++i)
    if (!(limits.lower(i) <= limits.upper(i)))
      throw InputError(fmt::format("limits of MV {}", i),
                       fmt::format("{} to {}", limits.lower(i), limits.upper(i)),
                       "a lower limit that is not above the upper one");
}

}  // namespace

Eigen::VectorXd saturated_shares(const Eigen::Ref<const Eigen::MatrixXd>& u, const MvLimits& limits) {
  require_limits(u, limits);
  Eigen::VectorXd shares(u.rows());
  for (Eigen::Index i = 0; i < u.rows(); ++i) {
    const auto at_limits = std::count_if(u.row(i).begin(), u.row(i).end(), [&](double value) {
      return at_or_below(value, limits.lower(i)) || at_or_above(value, limits.upper(i));
    });
    shares(i) = static_cast<double>(at_limits) / static_cast<double>(u.cols());
  }
  return shares;
}

std::vector<MvUse> mv_uses(const Eigen::Ref<const Eigen::MatrixXd>& u, const MvLimits& limits,
                           double largest_share, double smallest_deviation) {
  const Eigen::VectorXd shares = saturated_shares(u, limits);
  std::vector<MvUse> uses;
  for (Eigen::Index i = 0; i < u.rows(); ++i) {
    const Eigen::VectorXd signal = u.row(i).transpose();
    const double scatter = variance(signal);
    const bool still = stands_still(signal) || scatter <= variance_floor(signal) ||
                       scatter <= smallest_deviation * smallest_deviation;
    uses.push_back(shares(i) > largest_share ? MvUse::saturated
                   : still                   ? MvUse::standing_still
                                             : MvUse::evaluated);
  }
  return uses;
}

}  // namespace mpm
