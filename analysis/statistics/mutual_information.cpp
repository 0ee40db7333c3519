#include "analysis/statistics/mutual_information.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

struct BinnedSignal {
  std::vector<Eigen::Index> bin;  ///< of each sample
  Eigen::Index bins = 0;          ///< number of bins that have samples
};

/// Sorts each value into the bin of its mean rank.
BinnedSignal binned(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index bins) {
  const auto n = static_cast<std::size_t>(x.size());
  std::vector<Eigen::Index> sorted(n);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [&](Eigen::Index a, Eigen::Index b) { return x(a) < x(b); });
  BinnedSignal result{std::vector<Eigen::Index>(n), 0};
  Eigen::Index last = -1;
  for (std::size_t first = 0; first < n;) {
    std::size_t end = first;
    while (end < n && x(sorted[end]) == x(sorted[first]))
      ++end;
    const auto place = static_cast<Eigen::Index>((first + end - 1) / 2);
    if (const Eigen::Index bin = place * bins / x.size(); bin != last) {
      last = bin;
      ++result.bins;
    }
    for (std::size_t i = first; i < end; ++i)
      result.bin[static_cast<std::size_t>(sorted[i])] = result.bins - 1;
    first = end;
  }
  return result;
}

/// Returns ln P(chi^2(freedom) > x).
double log_chi_squared_tail(double x, double freedom) {
  const double a = 0.5 * freedom;
  const double half = 0.5 * x;
  if (const double p = boost::math::gamma_q(a, half); p > 1e-250)
    return std::log(p);
  return (a - 1.0) * std::log(half) - half - boost::math::lgamma(a);  // the leading term for large x
}

}  // namespace

BinnedInformation binned_information(const Eigen::Ref<const Eigen::VectorXd>& x,
                                     const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index bins) {
  if (bins < 2)
    throw InputError("bins of a signal", fmt::format("{}", bins), "2 or more");
  require_same_length("first signal", x, "second signal", y);
  require_signal("first signal", x, 5 * bins * bins);
  require_signal("second signal", y, 5 * bins * bins);
  const BinnedSignal of_x = binned(x, bins);
  const BinnedSignal of_y = binned(y, bins);
  BinnedInformation found;
  if (of_x.bins < 2 || of_y.bins < 2)
    return found;
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(of_x.bins, of_y.bins);
  for (std::size_t k = 0; k < of_x.bin.size(); ++k)
    counts(of_x.bin[k], of_y.bin[k]) += 1.0;
  const auto n = static_cast<double>(x.size());
  const Eigen::MatrixXd expected = counts.rowwise().sum() * counts.colwise().sum() / n;
  for (Eigen::Index j = 0; j < counts.cols(); ++j)
    for (Eigen::Index i = 0; i < counts.rows(); ++i)
      if (counts(i, j) > 0.0)
        found.information += counts(i, j) / n * std::log(counts(i, j) / expected(i, j));
  found.log_p = log_chi_squared_tail(2.0 * n * std::max(0.0, found.information),
                                     static_cast<double>((of_x.bins - 1) * (of_y.bins - 1)));
  return found;
}

}  // namespace mpm
