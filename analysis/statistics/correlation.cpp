#include "analysis/statistics/correlation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

template <class Visitor>
void for_each_finite_pair(const Signal& x, const Signal& y, Visitor visit) {
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (std::isfinite(x[k]) && std::isfinite(y[k])) {
      visit(x[k], y[k]);
    }
  }
}

}  // namespace

CentredSums centred_sums(const Signal& x, const Signal& y) {
  if (x.size() != y.size()) {
    throw InputError("lengths of the members of a correlation", fmt::format("{} and {}", x.size(), y.size()),
                     "equal lengths");
  }
  Eigen::Index pairs = 0;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for_each_finite_pair(x, y, [&](double a, double b) {
    ++pairs;
    mean_x += a;
    mean_y += b;
  });
  if (pairs == 0) {
    return {};
  }
  const double n = static_cast<double>(pairs);
  mean_x /= n;
  mean_y /= n;

  // Local sums stay in registers; the members of the returned struct would not.
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for_each_finite_pair(x, y, [&](double a, double b) {
    xx += (a - mean_x) * (a - mean_x);
    xy += (a - mean_x) * (b - mean_y);
    yy += (b - mean_y) * (b - mean_y);
  });
  return {pairs, mean_x, mean_y, xx, xy, yy};
}

double pearson_correlation(const Signal& x, const Signal& y, Eigen::Index fewest_pairs, double resolution) {
  return pearson_correlation(centred_sums(x, y), fewest_pairs, resolution);
}

double pearson_correlation(const CentredSums& sums, Eigen::Index fewest_pairs, double resolution) {
  if (fewest_pairs < 2) {
    throw InputError("fewest pairs of a correlation", fmt::format("{}", fewest_pairs), "2 or more");
  }
  if (sums.pairs < fewest_pairs) {
    return kNaN;
  }
  const double spread_x = std::sqrt(sums.xx);
  const double spread_y = std::sqrt(sums.yy);
  const double smallest_spread = resolution * std::sqrt(static_cast<double>(sums.pairs));
  if (!(spread_x > smallest_spread) || !(spread_y > smallest_spread)) {
    return kNaN;
  }
  return std::clamp(sums.xy / spread_x / spread_y, -1.0, 1.0);
}

}  // namespace mpm
