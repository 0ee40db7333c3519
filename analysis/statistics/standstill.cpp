#include "analysis/statistics/standstill.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// A stretch of equal values, with their number: samples between them may be missing.
struct EqualValues {
  Eigen::Index first, end, count;

  Eigen::Index length() const { return end - first; }
};

std::vector<EqualValues> equal_values(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  std::vector<EqualValues> stretches;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (std::isnan(values(k)))
      continue;
    if (stretches.empty() || values(k) != values(stretches.back().first))
      stretches.push_back({k, k, 0});
    stretches.back().end = k + 1;
    ++stretches.back().count;
  }
  return stretches;
}

/// Returns N p^(n - 1), see Standstill::chance.
double chance_of(Eigen::Index samples, double p, Eigen::Index count) {
  return static_cast<double>(samples) * std::pow(p, static_cast<double>(count - 1));
}

}  // namespace

Standstill longest_standstill(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  const std::vector<EqualValues> stretches = equal_values(values);
  const auto longest =
      std::max_element(stretches.begin(), stretches.end(),
                       [](const EqualValues& a, const EqualValues& b) { return a.count < b.count; });
  if (longest == stretches.end())
    return {};
  // A stretch has one pair of equal neighbours fewer than values. Its last value and the next stretch differ.
  double equal = 0.0, neighbours = 0.0;
  for (const EqualValues& each : stretches)
    if (each.first != longest->first) {
      equal += static_cast<double>(each.count - 1);
      neighbours += static_cast<double>(each.count);
    }
  const double p = (equal + 1.0) / (neighbours + 2.0);
  return {longest->first, longest->end, std::min(1.0, chance_of(values.size(), p, longest->count))};
}

Eigen::RowVectorXd without_standstills(Eigen::RowVectorXd values) {
  constexpr double kNoChance = 0.05;
  const std::vector<EqualValues> stretches = equal_values(values);
  const auto standing = std::count_if(stretches.begin(), stretches.end(),
                                      [](const EqualValues& each) { return each.count > 1; });
  const double p = (static_cast<double>(standing) + 1.0) / (static_cast<double>(stretches.size()) + 2.0);
  for (const EqualValues& each : stretches)
    if (chance_of(values.size(), p, each.count) < kNoChance &&
        !is_long({each.first, each.end}, values.size()))
      values.segment(each.first + 1, each.length() - 1).setConstant(kNaN);
  return values;
}

bool is_long(const Standstill& stretch, Eigen::Index samples) {
  constexpr Eigen::Index kFewestSamples = 20;
  constexpr double kLeastShare = 0.1;
  return stretch.length() > kFewestSamples &&
         static_cast<double>(stretch.length()) > kLeastShare * static_cast<double>(samples);
}

bool is_frozen(const Standstill& stretch, Eigen::Index samples) {
  constexpr double kNoChance = 1e-6;
  return is_long(stretch, samples) && stretch.chance < kNoChance;
}

}  // namespace mpm
